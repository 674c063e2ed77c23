// The expected result of a conversion, from the area of its surfaces. Constant factors were
// measured on the scenes at dim 64 to 1024.

#include "libvox/pipeline/estimate.h"

#include "libvox/core/memory.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/crop_polygons.h"
#include "libvox/pipeline/few_polygons.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/prepare/enclosure.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <unordered_set>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using MaskLeaf = openvdb::MaskTree::LeafNodeType;
using MaskUpper = openvdb::MaskTree::RootNodeType::ChildNodeType;
using MaskLower = MaskUpper::ChildNodeType;
using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using FloatUpper = openvdb::FloatTree::RootNodeType::ChildNodeType;
using FloatLower = FloatUpper::ChildNodeType;

/// Sizes of surfaces, in voxels.
struct Measure {
  double area = 0;
  double taxicabArea = 0;  ///< integral of |nx| + |ny| + |nz|: number of unit cubes that it meets
  double largestArea = 0;  ///< integral of max(|nx|, |ny|, |nz|): fewest cubes that separate it
  double volume = 0;       ///< inside
  double sheetArea = 0;    ///< of surfaces without an inside
  double activeVoxels = 0;
  double leaves = 0;      ///< nodes of 8^3 voxels
  double lowers = 0;      ///< of 128^3
  double uppers = 0;      ///< of 4096^3
  bool textured = false;  ///< colours differ from voxel to voxel
  bool smooth = false;    ///< normals differ from voxel to voxel

  /// Of a part of them.
  Measure times(double share) const {
    Measure part = *this;
    for (double* size : {&part.area, &part.taxicabArea, &part.largestArea, &part.volume,
                         &part.sheetArea, &part.activeVoxels, &part.leaves, &part.lowers})
      *size *= share;
    return part;
  }
};

/// The cubes of 2^log2 voxels a side that polygons meet. Gives up, without a count, where the
/// polygons are so large that finding the cubes takes too long.
class Cubes {
 public:
  Cubes(int log2, double mostPieces) : log2_(log2), mostPieces_(mostPieces) {}

  void add(const PolygonMesh& mesh, double area) {
    complete_ = complete_ && area / (piece() * piece()) <= mostPieces_;
    if (!complete_) return;
    parallelForRanges(mesh.faceCount(), kElementsPerTask, [&](std::size_t begin, std::size_t end) {
      Found found;
      for (std::size_t f = begin; f < end; ++f) {
        const auto face = mesh.face(static_cast<Index>(f));
        const auto& p = mesh.points;
        for (std::size_t i = 1; i + 1 < face.size(); ++i)
          addTriangle(p[face[0]], p[face[i]], p[face[i + 1]], found);
      }
      const std::lock_guard guard(lock_);
      cubes_.insert(found.cubes.begin(), found.cubes.end());
    });
    complete_ = cuts_ < kMostCuts;
  }

  /// Number of cubes; empty if it gave up.
  std::optional<double> count() const { return countOf(log2_); }
  /// Number of larger cubes; empty if it gave up.
  std::optional<double> countOf(int log2) const {
    if (!complete_) return std::nullopt;
    std::unordered_set<Coord> larger;
    for (const Coord& cube : cubes_) larger.insert(cube >> (log2 - log2_));
    return static_cast<double>(larger.size());
  }

 private:
  static constexpr std::size_t kMostCuts = 1'000'000;

  double piece() const { return std::ldexp(0.5, log2_); }

  /// The cubes that some triangles meet.
  struct Found {
    std::vector<Coord> cubes;  // without repeats in a row: neighbours share their cube
    void add(const Coord& cube) {
      if (cubes.empty() || cubes.back() != cube) cubes.push_back(cube);
    }
  };

  void addTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, Found& found) {
    const Vec3d low = a.cwiseMin(b).cwiseMin(c);
    const Vec3d high = a.cwiseMax(b).cwiseMax(c);
    for (const Vec3d& p : {a, b, c}) found.add(Coord::round(openvdb::Vec3d(p.data())) >> log2_);
    if ((high - low).maxCoeff() <= piece() || ++cuts_ >= kMostCuts) return;
    const double ab = (b - a).norm();
    const double bc = (c - b).norm();
    const double ca = (a - c).norm();
    if (ab >= bc && ab >= ca) return addHalves(c, a, b, found);
    if (bc >= ca) return addHalves(a, b, c, found);
    addHalves(b, c, a, found);
  }
  /// Cuts the side from a to b.
  void addHalves(const Vec3d& top, const Vec3d& a, const Vec3d& b, Found& found) {
    const Vec3d middle = (a + b) / 2;
    addTriangle(top, a, middle, found);
    addTriangle(top, middle, b, found);
  }

  int log2_;
  double mostPieces_;
  bool complete_ = true;
  std::atomic<std::size_t> cuts_ = 0;
  std::mutex lock_;
  std::unordered_set<Coord> cubes_;
};

bool hasOpenEdge(const SubdivisionLevel& base) {
  const Index corners = base.mesh.cornerCount();
  return lowestWhere(corners, kElementsPerTask, [&](Index c) { return base.isOpen(c); }) < corners;
}

/// True if a surface may become far smaller than its control mesh: then nothing is certain.
bool shrinks(const PreparedSurface& surface) {
  return surface.base.boundary == BoundaryStage::kPlain && hasOpenEdge(surface.base);
}

struct Areas {
  double area = 0;
  double taxicab = 0;
  double largest = 0;
  Areas& operator+=(const Areas& part) {
    area += part.area;
    taxicab += part.taxicab;
    largest += part.largest;
    return *this;
  }
};

Areas areasOf(const PolygonMesh& polygons) {
  const auto sumOf = [&](std::size_t begin, std::size_t end) {
    Areas sum;
    for (std::size_t f = begin; f < end; ++f) {
      const auto face = polygons.face(static_cast<Index>(f));
      const Vec3d twice = twiceAreaVector(
          face.size(), [&](std::size_t i) -> const Vec3d& { return polygons.points[face[i]]; });
      sum += {twice.norm() / 2, twice.cwiseAbs().sum() / 2, twice.cwiseAbs().maxCoeff() / 2};
    }
    return sum;
  };
  return parallelSum(polygons.faceCount(), kElementsPerTask, Areas{}, sumOf);
}

/// Number of active voxels. Vertex conversion misses some cubes that the surface only just cuts.
double activeVoxelsOf(const ConversionWay& way, const Measure& m) {
  constexpr double kOfCubes = 0.75;
  if (!way.polygons) return kOfCubes * m.taxicabArea;
  return way.separation == Separation::k26 ? m.taxicabArea : m.largestArea;
}

/// The box of the cubes of a region.
Box boxOf(const Region& region) {
  constexpr double kHalf = 0.5;
  const openvdb::CoordBBox& voxels = *region.box();
  Box box{Vec3d(voxels.min().x(), voxels.min().y(), voxels.min().z()),
          Vec3d(voxels.max().x(), voxels.max().y(), voxels.max().z())};
  box.low.array() -= kHalf;
  box.high.array() += kHalf;
  return box;
}

Measure measureOf(const PreparedSurface& surface, const Region& region, Cubes& leaves,
                  Cubes& lowers) {
  Measure measure;
  const std::optional<PolygonMesh> few = fewPolygons(surface.base, levelOf(surface.way));
  const PolygonMesh& whole = few ? *few : surface.base.mesh;
  PolygonMesh cropped;
  if (region.box()) cropped = croppedTo(boxOf(region), whole);
  const PolygonMesh& polygons = region.box() ? cropped : whole;
  const Areas areas = areasOf(polygons);
  measure.area = areas.area;
  measure.taxicabArea = areas.taxicab;
  measure.largestArea = areas.largest;
  leaves.add(polygons, measure.area);
  lowers.add(polygons, measure.area);
  const bool open = hasOpenEdge(surface.base);
  if (open) measure.sheetArea = measure.area;
  if (!open)
    measure.volume =
        std::max(0.0, region.box() ? volumeWithin(boxOf(region), whole)
                                   : signedVolume(whole, numbered(whole.faceCount())).volume);
  measure.activeVoxels = activeVoxelsOf(surface.way, measure);
  return measure;
}

Measure measureOf(std::span<const PreparedSurface> surfaces, const Region& region) {
  Measure all;
  constexpr double kMostLeafPieces = 5000;
  constexpr double kMostLowerPieces = 100000;
  Cubes leaves(MaskLeaf::TOTAL, kMostLeafPieces);
  Cubes lowers(MaskLower::TOTAL, kMostLowerPieces);
  for (const PreparedSurface& surface : surfaces) {
    const Measure one = measureOf(surface, region, leaves, lowers);
    all.area += one.area;
    all.taxicabArea += one.taxicabArea;
    all.volume += one.volume;
    all.sheetArea += one.sheetArea;
    all.activeVoxels += one.activeVoxels;
    all.textured |=
        surface.texture || !surface.look.looks.empty() || !surface.base.mesh.pointColors.empty();
    all.smooth |= levelOf(surface.way) != 0;
  }
  const auto met = [&](double side) { return 1.05 * all.taxicabArea / (side * side) + 1; };
  all.leaves = leaves.count().value_or(met(MaskLeaf::DIM));
  all.lowers = lowers.count().value_or(met(MaskLower::DIM));
  all.uppers = lowers.countOf(MaskUpper::TOTAL).value_or(met(MaskUpper::DIM));
  return all;
}

constexpr double kHeap = 16;  // overhead of the heap for a node
constexpr double kFilePerUpper = 9200;
constexpr double kFilePerLower = 1100;
constexpr double kCellBytes = 40;  // for each square voxel of the surface: cells and their bins
constexpr double kMoreFilePerLeaf = 50;  // if its values are all equal

GridEstimate estimateMask(const Measure& m) {
  GridEstimate grid{GridKind::kMask};
  grid.voxels = m.activeVoxels;
  grid.leaves = m.leaves;
  grid.bytes = grid.leaves * (sizeof(MaskLeaf) + kHeap) + m.lowers * sizeof(MaskLower) +
               m.uppers * sizeof(MaskUpper);
  grid.peakBytes = grid.bytes;
  constexpr double kFilePerLeaf = 140;
  grid.fileBytes = grid.leaves * kFilePerLeaf + m.lowers * kFilePerLower + m.uppers * kFilePerUpper;
  return grid;
}

double bytesOfValues(double leaves, const Measure& m) {
  constexpr double kLeaf = sizeof(FloatLeaf) + FloatLeaf::SIZE * sizeof(float) + kHeap;
  return leaves * kLeaf + m.lowers * sizeof(FloatLower) + m.uppers * sizeof(FloatUpper);
}

/// The part of the area that has an inside.
double closedShare(const Measure& m) {
  return m.area > 0 ? 1 - m.sheetArea / m.area : 0;
}

GridEstimate estimateDensity(const Measure& m, const VolumeSettings& volume) {
  GridEstimate grid = estimateMask(m);
  grid.kind = GridKind::kDensity;
  const bool solid = volume.fill == Fill::kSolid;
  if (solid) grid.voxels = m.volume + m.activeVoxels * (1 - closedShare(m) / 2);
  grid.peakBytes = bytesOfValues(grid.leaves, m) + (solid ? 2 * grid.bytes : 0);
  grid.bytes = bytesOfValues(grid.leaves, m);
  grid.fileBytes += grid.leaves * kMoreFilePerLeaf;
  return grid;
}

/// With soft edges. The cubes of a leaf lie in a cube of 8 voxels a side, and those that meet a
/// shell within half a voxel of it.
GridEstimate estimateSoftDensity(const Measure& m, const VolumeSettings& volume) {
  const bool solid = volume.fill == Fill::kSolid;
  const double sheets = solid ? m.sheetArea : m.area;
  const double shell = m.area / (FloatLeaf::DIM * FloatLeaf::DIM);  // leaves that it adds
  GridEstimate grid = estimateMask(m);
  grid.kind = GridKind::kDensity;
  // Half of the cubes that a surface of a body crosses have their centres outside.
  const double outer = solid && m.sheetArea == 0 ? m.taxicabArea / 2 : m.taxicabArea;
  grid.voxels = m.volume * (solid ? 1 : 0) + outer + sheets;
  const double masks = (solid ? 3 : 1) * grid.bytes;
  if (!solid) grid.leaves += shell / FloatLeaf::DIM;
  grid.bytes = bytesOfValues(grid.leaves, m);
  // The voxels around those of the surface are looked at, too.
  const double leavesNear = m.leaves + 3 * shell / FloatLeaf::DIM;
  grid.peakBytes = bytesOfValues(leavesNear, m) + masks + kCellBytes * m.area;
  const double filePerVoxel = volume.half ? 2.2 : 4.2;
  constexpr double kWithInner = 1.7;  // leaves at the surface also hold voxels deep inside
  grid.fileBytes += ((solid ? kWithInner : 1) * m.taxicabArea + sheets) * filePerVoxel;
  return grid;
}

GridEstimate estimateSurface(const Measure& m, const VolumeSettings& volume) {
  // Inside there may be less room than the band is wide. The volume may be too small: that of
  // polygons.
  constexpr double kLeastDepth = 3;
  const double closedArea = m.area - m.sheetArea;
  const double inner = std::min(volume.band.in * closedArea,
                                std::max(m.volume + closedArea, kLeastDepth * closedArea));
  const double band = volume.band.out * (m.area + m.sheetArea) + inner;
  GridEstimate grid{GridKind::kSurface};
  grid.voxels = band;
  grid.leaves = std::max(m.leaves, (8 * m.taxicabArea + band) / FloatLeaf::SIZE);
  grid.bytes = bytesOfValues(grid.leaves, m);
  grid.peakBytes = grid.bytes + kCellBytes * m.area;
  const double filePerVoxel = volume.half ? 2.6 : 4.4;
  grid.fileBytes = grid.voxels * filePerVoxel + m.lowers * kFilePerLower + m.uppers * kFilePerUpper;
  return grid;
}

/// Number of voxels of normals or colours around a soft density. A layer of voxels that touch
/// others at corners holds as many as the surface crosses.
double voxelsAroundSoft(GridKind kind, const Measure& m, const VolumeSettings& volume) {
  const double shell = m.taxicabArea + m.area;
  const double closed = volume.fill == Fill::kSolid ? closedShare(m) : 0;
  const double edge =
      closed * std::min(2 * m.taxicabArea, m.taxicabArea / 2 + m.volume) + (1 - closed) * shell;
  return kind == GridKind::kColor ? edge + 2 * m.taxicabArea : edge;
}

/// Normals or colours.
/// @param vary    from voxel to voxel
/// @param voxels  of the grid; empty: those of the surface
GridEstimate estimateVectors(GridKind kind, const Measure& m, bool vary,
                             std::optional<double> voxels) {
  using Leaf = openvdb::Vec3STree::LeafNodeType;
  using Upper = openvdb::Vec3STree::RootNodeType::ChildNodeType;
  GridEstimate grid = estimateMask(m);
  grid.kind = kind;
  if (voxels) {
    grid.voxels = *voxels;
    grid.leaves += std::max(0.0, *voxels - m.taxicabArea) / Leaf::SIZE;
  }
  constexpr double kLeaf = sizeof(Leaf) + Leaf::SIZE * sizeof(openvdb::Vec3s) + kHeap;
  grid.bytes =
      grid.leaves * kLeaf + m.lowers * sizeof(Upper::ChildNodeType) + m.uppers * sizeof(Upper);
  grid.peakBytes = grid.bytes + kCellBytes * m.area;
  constexpr double kMoreFilePerVoxel = 10;
  grid.fileBytes += vary ? grid.voxels * kMoreFilePerVoxel : grid.leaves * kMoreFilePerLeaf;
  return grid;
}

/// Parts of the surface; with Fill::kSolid also of the inside, voxel by voxel.
GridEstimate estimateParts(const Measure& m, const VolumeSettings& volume,
                           std::optional<double> voxels) {
  GridEstimate grid = estimateDensity(m, volume);
  grid.kind = GridKind::kPart;
  if (voxels && volume.fill == Fill::kSurface) grid.voxels = *voxels;
  grid.peakBytes = grid.bytes + kCellBytes * m.area;
  constexpr double kNeighbours = 200;  // of a leaf
  if (volume.fill == Fill::kSolid)
    grid.peakBytes += m.volume / FloatLeaf::SIZE *
                      (sizeof(FloatLeaf) + FloatLeaf::SIZE * sizeof(float) + kNeighbours);
  return grid;
}

/// Number of largest nodes at any resolution. A compact model around the origin always has some; a
/// model that is scattered over far more space than its surface fills keeps all of them.
double fixedUppers(const Measure& m) {
  constexpr double kAroundOrigin = 8;
  constexpr double kSide = MaskUpper::DIM;
  const bool scattered = m.uppers > kAroundOrigin + 4 * m.taxicabArea / (kSide * kSide);
  return scattered ? m.uppers : std::min(m.uppers, kAroundOrigin);
}

/// @param withDensity  whether that grid is made, too
GridEstimate estimateOf(GridKind kind, const Measure& m, const VolumeSettings& volume,
                        bool withDensity) {
  std::optional<double> voxels;
  if (withDensity && volume.edge == Edge::kSoft) voxels = voxelsAroundSoft(kind, m, volume);
  switch (kind) {
    case GridKind::kMask:
      return estimateMask(m);
    case GridKind::kDensity:
      return volume.edge == Edge::kSoft ? estimateSoftDensity(m, volume)
                                        : estimateDensity(m, volume);
    case GridKind::kSurface:
      return estimateSurface(m, volume);
    case GridKind::kNormal:
      return estimateVectors(kind, m, m.smooth, voxels);
    case GridKind::kColor:
      return estimateVectors(kind, m, m.textured, voxels);
    case GridKind::kPart:
      return estimateParts(m, volume, voxels);
  }
  return {kind};
}

}  // namespace

Estimate estimateGrids(std::span<const PreparedSurface> surfaces, std::span<const GridKind> kinds,
                       const VolumeSettings& volume, const Region& region, double share,
                       bool cutsLevelSets) {
  const Measure measure = measureOf(surfaces, region).times(share);
  // The inside is found in the whole, and cropped then.
  const bool inside = needsInside(kinds, volume);
  const bool needsWhole = !region.isAll() && inside;
  const Measure marked = needsWhole ? measureOf(surfaces, {}) : measure;
  Estimate all;
  const bool voxels = needsVoxels(kinds);
  const bool withDensity = std::find(kinds.begin(), kinds.end(), GridKind::kDensity) != kinds.end();
  if (voxels) all.voxels = measure.activeVoxels;
  all.bytes = voxels ? estimateMask(marked).bytes : 0;
  double uppers = voxels ? sizeof(MaskUpper) : 0;
  for (const GridKind kind : kinds) {
    GridEstimate grid = estimateOf(kind, measure, volume, withDensity);
    if (needsWhole && kind == GridKind::kSurface && !cutsLevelSets)
      grid.peakBytes = estimateSurface(marked, volume).peakBytes;
    if (needsWhole && kind == GridKind::kPart)
      grid.peakBytes = estimateParts(marked, volume, {}).peakBytes;
    if (needsWhole && kind == GridKind::kDensity)
      grid.peakBytes += 2 * (estimateMask(marked).bytes - estimateMask(measure).bytes);
    if (kind != GridKind::kMask) {
      all.bytes += grid.peakBytes;
      uppers += sizeof(openvdb::Vec3STree::RootNodeType::ChildNodeType);  // the largest
    }
    all.fileBytes += grid.fileBytes;
    all.grids.push_back(grid);
  }
  all.fixedBytes = uppers * fixedUppers(measure);
  if (inside && voxels) all.wholeBytes = 3 * estimateMask(marked).bytes;
  all.certain = std::none_of(surfaces.begin(), surfaces.end(), shrinks);
  return all;
}

int levelsOf(const PreparedSurface& surface, Progress& progress) {
  const StopRule& until = surface.way.until;
  if (const auto level = levelOf(surface.way)) return *level;
  if (surface.way.polygons)
    return planPolygons(surface.base, until, surface.options, progress).levels;
  double largest = 0;
  std::vector<Vec3d> points;
  const PolygonMesh& mesh = surface.base.mesh;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    points.clear();
    for (const Index v : mesh.face(f)) points.push_back(mesh.points[v]);
    largest = std::max(largest, diameter(points));
  }
  // A face halves with each step. Some vertices beside a boundary take two steps more.
  const int more = surface.base.boundary == BoundaryStage::kExtend ? 2 : 0;
  return std::max(1,
                  more + static_cast<int>(std::ceil(std::log2(largest / kVertexConversionSpan))));
}

namespace {

/// How many parts fit each, even if the estimate is too low; nothing: none would.
std::optional<std::int64_t> partsThatFit(const Estimate& estimate, double left) {
  constexpr double kLargest = 1.25;  // part, of the mean
  const double inEach = std::max(estimate.fixedBytes, estimate.wholeBytes);
  const double most = left / kEstimateFactor - inEach;
  if (most <= 0 || !estimate.shares.empty()) return std::nullopt;
  const double count = std::ceil(kLargest * (estimate.bytes - inEach) / most);
  if (!(count <= kMostRunParts)) return std::nullopt;
  return std::max<std::int64_t>(2, static_cast<std::int64_t>(count));
}

}  // namespace

std::string refusalOf(const Estimate& estimate, double longestSide, const MemoryBudget& budget) {
  const double left = static_cast<double>(budget.left());
  if (!estimate.certain || estimate.bytes <= kEstimateFactor * left) return {};
  std::ostringstream text;
  text << "the grids need about " << formatBytes(static_cast<std::uint64_t>(estimate.bytes))
       << " of memory on top of " << formatBytes(budget.limit() - budget.left())
       << ", the limit is " << formatBytes(budget.limit()) << "; ";
  // Grids grow with the square of the resolution, except for their largest nodes. The resolution
  // that is advised fits even if the estimate is too low.
  const double scale = std::sqrt(std::max(0.0, left / kEstimateFactor - estimate.fixedBytes) /
                                 (estimate.bytes - estimate.fixedBytes));
  const double voxelSize = estimate.voxelSize / scale;
  constexpr double kLeastScale = 1e-6;
  if (!(scale > kLeastScale) || longestSide < voxelSize) return text.str() + kScatteredAdvice;
  text.precision(3);
  text << "use --dim " << static_cast<std::int64_t>(longestSide / voxelSize) << " or --voxel-size "
       << voxelSize << ", or raise --max-memory";
  if (const auto parts = partsThatFit(estimate, left))
    text << ", or convert in " << *parts << " parts (--part 1/" << *parts << " and so on)";
  return text.str();
}

}  // namespace vox
