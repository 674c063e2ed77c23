// The level set of all objects: cells of their surfaces, and what is inside.

#include "libvox/pipeline/distance.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/foot/band.h"
#include "libvox/foot/exposed_band.h"
#include "libvox/foot/wide_band.h"
#include "libvox/grid/crop.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/pages.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/exposed_pieces.h"
#include "libvox/pipeline/foot_cells.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/page_signs.h"
#include "libvox/pipeline/sheets.h"
#include "libvox/volume/fill.h"
#include "libvox/volume/winding.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace vox {
namespace {

/// A component of an object.
struct Part {
  std::size_t surface;
  const MeshComponent* component;
  Box box;  // of its control points, which hold the surface, and a little more; index space

  bool isClosed() const { return component->side != MeshComponent::Side::kNoInside; }
};

/// Whether surfaces of components could touch, or lie in each other.
bool mayMeet(const std::vector<Part>& parts) {
  constexpr std::size_t kMostCompared = 1000;
  if (parts.size() > kMostCompared) return true;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (parts[i].box.meets(parts[j].box)) return true;
  return false;
}

bool facesInward(const Part& part) {
  return part.component->side == MeshComponent::Side::kIn;
}

/// The faces of some parts of a surface, ascending.
std::vector<Index> facesOf(std::span<const Part> parts) {
  std::vector<Index> faces;
  for (const Part& part : parts)
    faces.insert(faces.end(), part.component->faces.begin(), part.component->faces.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Calls visit(parts) for the parts of each surface.
template <class Visit>
void forEachSurface(const std::vector<Part>& parts, Visit&& visit) {
  for (auto begin = parts.begin(); begin != parts.end();) {
    const auto end = std::find_if(begin, parts.end(),
                                  [&](const Part& part) { return part.surface != begin->surface; });
    visit(std::span<const Part>(begin, end));
    begin = end;
  }
}

class LevelSetMaker {
 public:
  LevelSetMaker(std::span<const PreparedSurface> surfaces, const VolumeSettings& settings,
                double voxelSize, const MarkVoxels& markVoxels, const Region& region,
                MemoryBudget& budget, Progress& progress, std::vector<std::string>& warnings)
      : surfaces_(surfaces),
        settings_(settings),
        voxelSize_(voxelSize),
        markVoxels_(markVoxels),
        region_(region),
        budget_(budget),
        progress_(progress),
        warnings_(warnings) {
    for (const PreparedSurface& surface : surfaces)
      components_.push_back(componentsOf(surface.base));
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      for (const MeshComponent& component : components_[s]) {
        Part part{s, &component, boxOf(surfaces[s].base.mesh, component.faces)};
        constexpr double kTouching = 0.01;  // voxels: solids that touch may be off by rounding
        part.box.low.array() -= kTouching;
        part.box.high.array() += kTouching;
        (part.isClosed() ? closed_ : open_).push_back(part);
      }
  }

  openvdb::FloatTree::Ptr make() {
    if (!open_.empty()) findEnclosing();
    isLocal_ = region_.hasPages() && (closed_.empty() || (open_.empty() && !solidsMayMeet())) &&
               !isWide({settings_.band.in, settings_.band.out});
    openvdb::FloatTree::Ptr tree;
    if (!closed_.empty()) tree = bandOfSolids();
    if (tree && endsAtOthers_) addLids(*tree);
    if (!open_.empty()) {
      const openvdb::FloatTree::Ptr sheets = bandOfSheets();
      if (tree)
        unite(*tree, *sheets);
      else
        tree = sheets;
    }
    return tree;
  }

  bool hasSheets() const { return !open_.empty(); }

 private:
  /// Adds sheets to solids.
  void unite(openvdb::FloatTree& solids, openvdb::FloatTree& sheets) const {
    openvdb::tools::csgUnion(solids, sheets);
    // It leaves tiles inside with the background of the outside.
    const BandWidths& band = settings_.band;
    if (!band.isSymmetric())
      openvdb::tools::changeAsymmetricLevelSetBackground(solids, backgroundOf(band.out, voxelSize_),
                                                         -backgroundOf(band.in, voxelSize_));
  }

  /// Half width up to which all cells scan their tubes. Beyond it tubes spread too much.
  static constexpr double kMostExact = 8;  // voxels

  /// How far inside others a surface still counts where the band is wide: the voxels tell less well
  /// where surfaces are near each other.
  static constexpr double kExposedDepth = 1.7;  // voxels

  /// Open parts that enclose something become closed ones.
  void findEnclosing() {
    findInside();
    std::vector<Part> sheets;
    std::vector<bool> have;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const std::size_t s = open_[i].surface;
      if (i == 0 || open_[i - 1].surface != s)
        have = haveInside(surfaces_[s], components_[s], inside_, progress_);
      const auto number = static_cast<std::size_t>(open_[i].component - components_[s].data());
      (have[number] ? closed_ : sheets).push_back(open_[i]);
      if (have[number]) endsAtOthers_ = true;
    }
    open_ = std::move(sheets);
  }

  void findInside() {
    if (inside_.solid != nullptr) return;
    inside_.surface = &markVoxels_();
    budget_.require(bytesOfFilling(*inside_.surface), "the inside", kScatteredAdvice);
    solid_ = solidOf(*inside_.surface, surfaces_, settings_, budget_, progress_, warnings_);
    inside_.solid = solid_.voxels.get();
  }

  struct BandVoxel {
    openvdb::Coord at;
    float value;
    bool isActive;
  };

  using FloatValues = openvdb::tree::ValueAccessor<openvdb::FloatTree>;

  /// Where an open part ends at voxels that close it, sides of voxels are surface, too: the outer
  /// ones of voxels that close an opening, and those that the sign jumps across.
  void addLids(openvdb::FloatTree& tree) const {
    std::vector<std::pair<openvdb::Coord, openvdb::Coord>> sides = solid_.closure.sides;
    const double mostApart = 1.02 * voxelSize_;
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree> known(tree);
    for (auto value = std::as_const(tree).cbeginValueOn(); value; ++value) {
      const double a = *value;
      for (int i = 0; i < 6; ++i) {
        openvdb::Coord next = value.getCoord();
        next[i / 2] += i % 2 == 0 ? 1 : -1;
        openvdb::FloatTree::ValueType b = 0;
        const bool isActive = known.probeValue(next, b);
        if ((a < 0) == (b < 0) || std::abs(a - double{b}) <= mostApart) continue;
        if (i % 2 == 0 || !isActive) sides.emplace_back(value.getCoord(), next);
      }
    }
    FloatValues values(tree);
    for (const auto& [inner, outer] : sides) addLid(inner, outer, values);
    openvdb::tools::signedFloodFillWithValues(tree, backgroundOf(settings_.band.out, voxelSize_),
                                              -backgroundOf(settings_.band.in, voxelSize_));
  }

  /// Gives the voxels around the square between two neighbours their distances from it.
  void addLid(const openvdb::Coord& inner, const openvdb::Coord& outer, FloatValues& values) const {
    const BandWidths& band = settings_.band;
    const int reach =
        static_cast<int>(std::ceil(std::min(std::max(band.in, band.out), kMostExact)));
    const openvdb::CoordBBox around(inner.offsetBy(-reach), inner.offsetBy(reach));
    for (auto at = around.begin(); at != around.end(); ++at) {
      const double distance = distanceToSide(*at, inner, outer) * voxelSize_;
      const float value = values.getValue(*at);
      const bool isActive = values.isValueOn(*at);
      const bool isInside = isActive ? value < 0 : inside_.solid->isValueOn(*at);
      const double width = (isInside ? band.in : band.out) * voxelSize_;
      if (distance >= width || (isActive && distance >= std::abs(double{value}))) continue;
      values.setValue(*at, static_cast<float>(isInside ? -distance : distance));
    }
  }

  /// Distance, in voxels, of a voxel from the square between two neighbours.
  static double distanceToSide(const openvdb::Coord& voxel, const openvdb::Coord& a,
                               const openvdb::Coord& b) {
    Vec3d away;
    for (int axis = 0; axis < 3; ++axis) {
      const bool across = a[axis] != b[axis];
      const double off = std::abs(voxel[axis] - (a[axis] + b[axis]) / 2.0);
      away[axis] = across ? off : std::max(0.0, off - 0.5);
    }
    return away.norm();
  }

  /// Whether more than the side of the nearest surface tells what is inside.
  bool solidsMayMeet() const {
    return inside_.solid != nullptr || mayMeet(closed_) ||
           std::any_of(closed_.begin(), closed_.end(), facesInward);
  }

  openvdb::FloatTree::Ptr bandOfSolids() {
    const BandOptions options{settings_.band.in, settings_.band.out, voxelSize_, false, 0,
                              isLocal_};
    const bool overlap = solidsMayMeet();
    const double share = open_.empty() ? 1 : 0.9;  // of the stage
    if (!overlap)
      if (const openvdb::FloatTree::Ptr band = bandByFeet(options, share)) return band;
    return bandOfExposed(options, overlap ? share : 0);
  }

  openvdb::FloatTree::Ptr bandOfSheets() {
    constexpr double kHalfThickness = 0.5;
    const double half = settings_.openMesh == OpenMesh::kUnsigned ? 0 : kHalfThickness;
    const double out = settings_.band.out;  // no voxel is deeper than half the thickness
    const BandOptions options{out, out, voxelSize_, true, half, isLocal_};
    const BandOptions narrow = narrowed(options);
    const double share = closed_.empty() ? 1 : 0.1;
    FootCells cells(cellOptions(narrow, isWide(options)), regionOfBand(), budget_);
    addCells(open_, nullptr, kPartOfCells * share, cells);
    const FootBins bins = cells.bins();
    const Band band = makeBand(bins, narrow, progress_, (1 - kPartOfCells) * share);
    if (isWide(options)) widen(*band.tree, kMostExact, bins, options, progress_);
    return band.tree;
  }

  /// The band of solids that do not meet. Null if its jumps show that a solid meets itself.
  openvdb::FloatTree::Ptr bandByFeet(const BandOptions& options, double share) {
    const BandOptions narrow = narrowed(options);
    FootCells cells(cellOptions(narrow, isWide(options)), regionOfBand(), budget_);
    addCells(closed_, nullptr, kPartOfCells * share, cells);
    const FootBins bins = cells.bins();
    const Band band = makeBand(bins, narrow, progress_, (1 - kPartOfCells) * share);
    if (isLocal_) {
      if (!band.jumps.empty()) refuseMeeting(band.jumps);
      crop(*band.tree, region_);
      setInnerPages(*band.tree, region_, boxOfSolids(), -backgroundOf(narrow.in, voxelSize_),
                    [&](std::span<const openvdb::Coord> voxels) { return areInside(voxels); });
      return band.tree;
    }
    if (!band.jumps.empty()) {
      if (narrow.in != narrow.out || narrow.in < kLeastToExpose || isWide(options)) return nullptr;
      exposeParts(band, bins, narrow);
      return band.tree;
    }
    if (isWide(options)) widen(*band.tree, kMostExact, bins, options, progress_);
    return band.tree;
  }

  /// Holes of a band are closed from voxels around them.
  Region regionOfBand() const {
    constexpr int kMargin = 16;  // voxels
    return isLocal_ ? region_.grown(kMargin) : Region{};
  }

  /// @param jumps  leaves; not empty
  [[noreturn]] static void refuseMeeting(const std::vector<openvdb::Coord>& jumps) {
    const openvdb::Coord at = *std::min_element(jumps.begin(), jumps.end());
    throw MeshError("the surface meets itself near the voxel (" + std::to_string(at.x()) + ", " +
                    std::to_string(at.y()) + ", " + std::to_string(at.z()) +
                    "), and what is inside there depends on all of it: leave out --part, or the "
                    "grid surface");
  }

  openvdb::CoordBBox boxOfSolids() const {
    openvdb::CoordBBox box;
    for (const Part& part : closed_) {
      box.expand(openvdb::Coord::floor(openvdb::Vec3d(part.box.low.data())));
      box.expand(openvdb::Coord::ceil(openvdb::Vec3d(part.box.high.data())));
    }
    return box;
  }

  /// Whether voxels are inside some solid. They are many voxels away from the surface.
  std::vector<char> areInside(std::span<const openvdb::Coord> voxels) const {
    constexpr double kTolerance = kPageSide / 8.0;
    std::vector<char> inside(voxels.size(), 0);
    forEachSurface(closed_, [&](std::span<const Part> parts) {
      const PolygonMesh polygons = trianglesNear(surfaces_[parts[0].surface], facesOf(parts),
                                                 kTolerance, budget_, progress_);
      const std::vector<int> windings = windingNumbers(polygons, voxels);
      for (std::size_t i = 0; i < voxels.size(); ++i)
        if (windings[i] != 0) inside[i] = 1;
    });
    return inside;
  }

  /// The band of solids parts of which may lie inside others.
  openvdb::FloatTree::Ptr bandOfExposed(const BandOptions& options, double share) {
    BandOptions even = narrowed(options);
    even.in = even.out = std::max({even.in, even.out, kLeastToExpose});
    FootCells cells(cellOptions(even, isWide(options)), budget_);
    addCells(closed_, nullptr, kPartOfCells * share, cells);
    const FootBins bins = cells.bins();
    const Band band = makeBand(bins, even, progress_, (1 - kPartOfCells) * share);
    const openvdb::MaskTree::Ptr solid = exposeParts(band, bins, even);
    const BandOptions narrow = narrowed(options);
    if (even.in != narrow.in || even.out != narrow.out) trim(*band.tree, narrow);
    if (isWide(options)) widenExposed(*band.tree, *solid, options);
    return band.tree;
  }

  /// Takes the distances to hidden parts out of a band.
  /// @return voxels that are inside, or that a surface crosses
  openvdb::MaskTree::Ptr exposeParts(const Band& band, const FootBins& bins,
                                     const BandOptions& options) const {
    if (solid_.voxels) {
      constexpr double kNotCrossed = 1;  // voxels, from the surface
      std::vector<BandVoxel> besideBodies;
      if (!open_.empty() || endsAtOthers_)
        for (const openvdb::Coord& at : sheetVoxels(inside_, *band.tree, voxelSize_))
          besideBodies.push_back({at, band.tree->getValue(at), band.tree->isValueOn(at)});
      expose(band, bins, *solid_.voxels, kNotCrossed, options, progress_);
      for (const BandVoxel& voxel : besideBodies)
        if (voxel.isActive)
          band.tree->setValueOn(voxel.at, std::abs(voxel.value));
        else
          band.tree->setValueOff(voxel.at, backgroundOf(options.out, voxelSize_));
      return solid_.voxels;
    }
    const openvdb::MaskTree::Ptr walls = wallsOf(*band.tree, voxelSize_);
    budget_.require(bytesOfFilling(*walls), "the inside", kScatteredAdvice);
    const openvdb::MaskTree::Ptr solid =
        solidOf(*walls, surfaces_, settings_, budget_, progress_, warnings_).voxels;
    expose(band, bins, *solid, kLeastOfFree, options, progress_);
    return solid;
  }

  /// Continues a band beyond kMostExact.
  void widenExposed(openvdb::FloatTree& band, const openvdb::MaskTree& solid,
                    const BandOptions& options) const {
    FootCells cells(cellOptions(narrowed(options), true), budget_);
    addCells(closed_, &solid, 0, cells);
    widen(band, kMostExact, cells.bins(), options, progress_);
  }

  static constexpr double kPartOfCells = 0.3;  // of the work

  static bool isWide(const BandOptions& options) {
    return std::max(options.in, options.out) > kMostExact;
  }

  /// The part of a band that all cells scan.
  static BandOptions narrowed(const BandOptions& options) {
    BandOptions narrow = options;
    narrow.in = std::min(options.in, kMostExact);
    narrow.out = std::min(options.out, kMostExact);
    return narrow;
  }

  static CellOptions cellOptions(const BandOptions& options, bool isWide) {
    const double reach = std::max(options.in, options.out) + options.halfThickness;
    return {.reach = static_cast<float>(reach), .polynomials = !isWide, .places = false};
  }

  /// @param solid  if not null, only what is exposed counts, outside these voxels
  void addCells(const std::vector<Part>& parts, const openvdb::MaskTree* solid, double share,
                FootCells& cells) const {
    PieceFilter filter;
    if (solid != nullptr)
      filter = [&](LimitSink& next) {
        return std::make_unique<ExposedPieces>(*solid, kExposedDepth, next);
      };
    const double shareOfSurface = share / static_cast<double>(surfaces_.size());
    forEachSurface(parts, [&](std::span<const Part> ofSurface) {
      const PreparedSurface& surface = surfaces_[ofSurface[0].surface];
      const std::vector<Index> faces = facesOf(ofSurface);
      if (!levelOf(surface.way)) {
        cells.addLimitSurface(surface, faces, filter, progress_, shareOfSurface);
        return;
      }
      PolygonMesh triangles = trianglesOfLevel(surface, faces, budget_, progress_);
      if (solid != nullptr) triangles = exposedTriangles(triangles, *solid, kExposedDepth);
      cells.addTriangles(triangles, progress_);
    });
  }

  std::span<const PreparedSurface> surfaces_;
  const VolumeSettings& settings_;
  double voxelSize_;
  const MarkVoxels& markVoxels_;
  const Region& region_;
  MemoryBudget& budget_;
  Progress& progress_;
  std::vector<std::vector<MeshComponent>> components_;
  std::vector<Part> closed_, open_;
  bool endsAtOthers_ = false;  // an open part is one of closed_
  bool isLocal_ = false;       // only the pages of the region are made
  std::vector<std::string>& warnings_;
  Solid solid_;
  Inside inside_;
};

/// Whether no voxel lies deeper than half a voxel.
bool isThin(const openvdb::FloatTree& tree, double voxelSize) {
  const auto limit = static_cast<float>(-0.5 * voxelSize);
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    for (auto value = leaf->cbeginValueAll(); value; ++value)
      if (*value < limit) return false;
  return true;
}

}  // namespace

openvdb::FloatGrid::Ptr surfaceGrid(std::span<const PreparedSurface> surfaces,
                                    const VolumeSettings& settings,
                                    const openvdb::math::Transform& transform,
                                    const MarkVoxels& markVoxels, const Region& part,
                                    MemoryBudget& budget, Progress& progress,
                                    std::vector<std::string>& warnings) {
  const double voxelSize = transform.voxelSize()[0];
  LevelSetMaker maker(surfaces, settings, voxelSize, markVoxels, part, budget, progress, warnings);
  auto grid = openvdb::FloatGrid::create(maker.make());
  grid->setTransform(transform.copy());
  const bool isUnsigned = maker.hasSheets() && settings.openMesh == OpenMesh::kUnsigned;
  grid->setGridClass(isUnsigned ? openvdb::GRID_UNKNOWN : openvdb::GRID_LEVEL_SET);
  if (!maker.hasSheets() && !part.hasPages() && isThin(grid->tree(), voxelSize))
    warnings.push_back(
        "the objects are thinner than a voxel everywhere: the level set has hardly any inside; use "
        "smaller voxels");
  budget.take(grid->memUsage(), "the surface grid", kScatteredAdvice);
  return grid;
}

}  // namespace vox
