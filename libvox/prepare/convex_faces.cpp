// Outlines and holes by counting, for each loop, the loops around it.

#include "libvox/prepare/convex_faces.h"

#include "libvox/core/numbered.h"
#include "libvox/mesh/convex_parts.h"
#include "libvox/mesh/flat_polygon.h"
#include "libvox/prepare/face_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vox {
namespace {

constexpr std::uint64_t kMostWork = 2'000'000'000;  // loops times corners: half a minute
constexpr double kSliver = 1e-12;  // area of a loop that counts as none, of its box

/// A loop on the lattice.
struct FlatLoop {
  std::vector<Index> corners;  ///< counter-clockwise; numbered through all loops
  FlatPoint low, high;         ///< box
  Int128 area = 0;             ///< doubled
  Index depth = 0;             ///< number of loops around it
  Index inside = kNone;        ///< the smallest loop around it
};

Int128 signedArea(std::span<const FlatPoint> flat, const std::vector<Index>& corners) {
  Int128 area = 0;
  for (std::size_t i = 2; i < corners.size(); ++i)
    area += turn(flat[corners[0]], flat[corners[i - 1]], flat[corners[i]]);
  return area;
}

FlatLoop flatLoop(std::span<const FlatPoint> flat, std::vector<Index> corners) {
  FlatLoop loop;
  loop.area = signedArea(flat, corners);
  if (loop.area < 0) {
    std::reverse(corners.begin(), corners.end());
    loop.area = -loop.area;
  }
  loop.low = loop.high = flat[corners[0]];
  for (const Index c : corners) {
    loop.low = {std::min(loop.low.x, flat[c].x), std::min(loop.low.y, flat[c].y)};
    loop.high = {std::max(loop.high.x, flat[c].x), std::max(loop.high.y, flat[c].y)};
  }
  loop.corners = std::move(corners);
  return loop;
}

bool isSliver(const FlatLoop& loop) {
  return static_cast<double>(loop.area) <= kSliver * squaredDistance(loop.low, loop.high);
}

enum class Side { kOutside, kOnIt, kInside };

Side sideOf(std::span<const FlatPoint> flat, const FlatLoop& loop, const FlatPoint& p) {
  bool inside = false;
  FlatPoint a = flat[loop.corners.back()];
  for (const Index corner : loop.corners) {
    const FlatPoint b = flat[corner];
    if ((a.y > p.y) != (b.y > p.y)) {
      const Int128 side = a.y < b.y ? turn(a, b, p) : turn(b, a, p);
      if (side == 0) return Side::kOnIt;
      inside ^= side > 0;
    } else if (a.y == p.y && b.y == p.y && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x)) {
      return Side::kOnIt;
    } else if (b == p || a == p) {
      return Side::kOnIt;
    }
    a = b;
  }
  return inside ? Side::kInside : Side::kOutside;
}

/// Whether loop `a` lies around loop `b`: the first corner of b that is not on a decides, then the
/// middle of a side.
bool isAround(std::span<const FlatPoint> flat, const FlatLoop& a, const FlatLoop& b) {
  if (b.low.x < a.low.x || b.low.y < a.low.y || b.high.x > a.high.x || b.high.y > a.high.y ||
      b.area >= a.area)
    return false;
  for (const Index corner : b.corners) {
    const Side side = sideOf(flat, a, flat[corner]);
    if (side != Side::kOnIt) return side == Side::kInside;
  }
  for (std::size_t i = 0; i < b.corners.size(); ++i) {
    const FlatPoint& p = flat[b.corners[i]];
    const FlatPoint& q = flat[b.corners[(i + 1) % b.corners.size()]];
    const Side side = sideOf(flat, a, {(p.x + q.x) / 2, (p.y + q.y) / 2});
    if (side != Side::kOnIt) return side == Side::kInside;
  }
  return false;
}

void nest(std::span<const FlatPoint> flat, std::vector<FlatLoop>& loops) {
  for (FlatLoop& b : loops)
    for (Index a = 0; a < loops.size(); ++a) {
      if (!isAround(flat, loops[a], b)) continue;
      ++b.depth;
      if (b.inside == kNone || loops[a].area < loops[b.inside].area) b.inside = a;
    }
}

/// The loops of a face in canonical form, in canonical order.
struct CanonicalLoops {
  std::vector<std::vector<Index>> loops;
  Vec3d normal = Vec3d::Zero();   ///< of the largest loop
  bool normalIsReversed = false;  ///< it points against the winding that this loop had

  CanonicalLoops(std::span<const Vec3d> points, std::span<const std::vector<Index>> given) {
    std::vector<std::pair<std::vector<Index>, bool>> order;
    for (const std::vector<Index>& loop : given) {
      order.emplace_back(loop, false);
      order.back().second = canonicalize(order.back().first);
    }
    std::sort(order.begin(), order.end());
    std::vector<Vec3d> corners;
    for (auto& [loop, reversed] : order) {
      corners.clear();
      for (const Index v : loop) corners.push_back(points[v]);
      const Vec3d area = twiceAreaVector(corners);
      if (area.stableNorm() > normal.stableNorm()) {
        normal = area;
        normalIsReversed = reversed;
      }
      loops.push_back(std::move(loop));
    }
  }
};

std::string text(const FaceSplit& split, const char* one, const char* many) {
  return "split " + std::to_string(split.faces) + (split.faces == 1 ? one : many) +
         std::to_string(split.parts);
}

bool hasRepeats(std::vector<Index> face) {
  std::sort(face.begin(), face.end());
  return std::adjacent_find(face.begin(), face.end()) != face.end();
}

/// An outline with its holes, as convexParts wants them.
std::vector<std::vector<Index>> regionOf(const std::vector<FlatLoop>& loops, Index outline) {
  std::vector<std::vector<Index>> region = {loops[outline].corners};
  for (const FlatLoop& loop : loops)
    if (loop.inside == outline && loop.depth == loops[outline].depth + 1)
      region.emplace_back(loop.corners.rbegin(), loop.corners.rend());
  return region;
}

}  // namespace

std::string summary(const FaceSplitReport& report) {
  std::string line;
  if (report.keyholes.faces > 0)
    line = text(report.keyholes, " face with holes into ", " faces with holes into ");
  if (report.concave.faces > 0)
    line += (line.empty() ? "" : ", ") +
            text(report.concave, " concave face into ", " concave faces into ");
  return line;
}

bool convexFaces(std::span<const Vec3d> points, std::span<const std::vector<Index>> loops,
                 std::vector<std::vector<Index>>& parts) {
  std::uint64_t cornerCount = 0;
  for (const std::vector<Index>& loop : loops) cornerCount += loop.size();
  if (loops.size() * cornerCount > kMostWork) return false;
  const CanonicalLoops canonical(points, loops);
  std::vector<Index> vertices;
  std::vector<Vec3d> positions;
  std::vector<std::vector<Index>> corners;
  for (const std::vector<Index>& loop : canonical.loops) {
    corners.emplace_back();
    for (const Index v : loop) {
      corners.back().push_back(static_cast<Index>(vertices.size()));
      vertices.push_back(v);
      positions.push_back(points[v]);
    }
  }
  const std::vector<FlatPoint> flat = flattened(positions, canonical.normal);
  std::vector<FlatLoop> flatLoops;
  for (std::vector<Index>& loop : corners) {
    flatLoops.push_back(flatLoop(flat, std::move(loop)));
    if (isSliver(flatLoops.back())) flatLoops.pop_back();
  }
  nest(flat, flatLoops);
  const bool hasHole = std::any_of(flatLoops.begin(), flatLoops.end(),
                                   [](const FlatLoop& loop) { return loop.depth % 2 == 1; });
  if (loops.size() > 1 && !hasHole) return false;

  parts.clear();
  std::vector<std::vector<Index>> partsOfRegion;
  for (Index i = 0; i < flatLoops.size(); ++i) {
    if (flatLoops[i].depth % 2 == 1) continue;
    if (!convexParts(positions, flat, regionOf(flatLoops, i), partsOfRegion)) return false;
    for (std::vector<Index>& part : partsOfRegion) {
      for (Index& corner : part) corner = vertices[corner];
      if (hasRepeats(part)) return false;
      if (canonical.normalIsReversed) std::reverse(part.begin(), part.end());
      parts.push_back(std::move(part));
    }
  }
  return parts.size() > 1;
}

}  // namespace vox
