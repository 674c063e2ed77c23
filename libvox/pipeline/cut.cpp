// Ranges of pages for runs in parts.

#include "libvox/pipeline/cut.h"

#include "libvox/mesh/area.h"
#include "libvox/pipeline/few_polygons.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace vox {
namespace {

using openvdb::Coord;

struct FileOrder {
  bool operator()(const Coord& a, const Coord& b) const { return isBefore(a, b); }
};
using Costs = std::map<Coord, std::uint64_t, FileOrder>;

/// Adds the area of triangles to the pages that they meet, in pieces of half a page, or in larger
/// ones if there would be too many.
class TriangleCosts {
 public:
  /// @param area  of all triangles
  TriangleCosts(const Region& region, double area, Costs& costs)
      : region_(region), longest_(longestFor(area)), costs_(costs), last_(costs.end()) {}

  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    if (region_.box() && !region_.meets(boxOf(a, b, c))) return;
    const double ab = (b - a).squaredNorm();
    const double bc = (c - b).squaredNorm();
    const double ca = (a - c).squaredNorm();
    const double longest = std::max({ab, bc, ca});
    if (longest > longest_ * longest_) {
      if (ab == longest) return addHalves(c, a, b);
      if (bc == longest) return addHalves(a, b, c);
      return addHalves(b, c, a);
    }
    const Vec3d middle = (a + b + c) / 3;
    const Coord voxel = Coord::round(openvdb::Vec3d(middle.data()));
    if (region_.box() && !region_.box()->isInside(voxel)) return;
    constexpr double kUnits = 1024;  // of a square voxel
    const double area = (b - a).cross(c - a).norm() / 2;
    const std::uint64_t cost = 1 + static_cast<std::uint64_t>(kUnits * area);
    const Coord page = voxel >> kPageLog2;
    if (last_ == costs_.end() || last_->first != page) last_ = costs_.try_emplace(page, 0).first;
    last_->second += cost;
  }

 private:
  static double longestFor(double area) {
    constexpr double kMostPieces = 1 << 18;
    return std::max(kPageSide / 2.0, std::sqrt(area / kMostPieces));
  }

  static Box boxOf(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    Box box;
    for (const Vec3d& point : {a, b, c}) box.add(point);
    return box;
  }

  /// Cuts the side from a to b.
  void addHalves(const Vec3d& top, const Vec3d& a, const Vec3d& b) {
    const Vec3d middle = (a + b) / 2;
    add(top, a, middle);
    add(top, middle, b);
  }

  const Region& region_;
  double longest_;
  Costs& costs_;
  Costs::iterator last_;
};

}  // namespace

PageCosts costsOf(std::span<const PreparedSurface> surfaces, const Region& region) {
  Costs costs;
  for (const PreparedSurface& surface : surfaces) {
    const std::optional<PolygonMesh> few = fewPolygons(surface.base, levelOf(surface.way));
    const PolygonMesh& polygons = few ? *few : surface.base.mesh;
    const auto& p = polygons.points;
    TriangleCosts triangles(region, areaOf(polygons), costs);
    for (Index f = 0; f < polygons.faceCount(); ++f) {
      const auto face = polygons.face(f);
      for (std::size_t i = 1; i + 1 < face.size(); ++i)
        triangles.add(p[face[0]], p[face[i]], p[face[i + 1]]);
    }
  }
  PageCosts sorted;
  for (const auto& [page, cost] : costs) {
    sorted.pages.push_back(page);
    sorted.costs.push_back(cost);
  }
  return sorted;
}

bool cutsLevelSets(std::span<const PageShare> shares) {
  constexpr std::size_t kMostOfSmall = 200;
  std::size_t pages = 0;
  for (const PageShare& share : shares) pages += share.pages;
  return pages > kMostOfSmall;
}

std::vector<PageShare> cutInto(int count, const PageCosts& costs) {
  double all = 0;
  for (const std::uint64_t cost : costs.costs) all += static_cast<double>(cost);
  const auto parts = static_cast<std::size_t>(count);
  // Coord::max() comes after all pages.
  std::vector<Coord> begins(parts + 1, Coord::max());
  std::vector<PageShare> shares(parts);
  double before = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < costs.pages.size(); ++i) {
    // Where its middle lies among all costs tells the part of a page.
    const auto cost = static_cast<double>(costs.costs[i]);
    const auto part = static_cast<std::size_t>((before + cost / 2) / all * count);
    last = std::clamp(part, last, parts - 1);
    before += cost;
    PageShare& share = shares[last];
    if (share.pages++ == 0) begins[last] = costs.pages[i];
    share.cost += cost / all;
  }
  for (std::size_t i = parts; i-- > 0;)  // parts without pages begin where the next one does
    if (shares[i].pages == 0) begins[i] = begins[i + 1];
  for (std::size_t i = 0; i < parts; ++i) {
    if (i > 0) shares[i].range.begin = begins[i];
    if (i + 1 < parts) shares[i].range.end = begins[i + 1];
  }
  return shares;
}

}  // namespace vox
