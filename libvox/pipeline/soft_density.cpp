// The part of each voxel that is inside, or near a surface.

#include "libvox/pipeline/soft_density.h"

#include "libvox/core/memory.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/nearest_feet.h"
#include "libvox/grid/crop.h"
#include "libvox/grid/enclosed.h"
#include "libvox/grid/grow.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/foot_cells.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/sheets.h"
#include "libvox/volume/coverage.h"
#include "libvox/volume/density.h"
#include "libvox/volume/fill.h"

#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace vox {
namespace {

// The cubes that a plane crosses are nearer than sqrt(3) / 2, and vertices that switched voxels on
// may lie a little off the limit surface.
constexpr double kReachOfCube = 0.867;
constexpr float kReachOfSolid = 1.1F;
// Where bodies meet, a voxel crossed by one of them may lie as deep as this in another.
constexpr float kReachOfSolids = 2;
// Half a voxel more, for the cubes that a shell crosses.
constexpr float kReachOfShell = 1.4F;

Float3 difference(const Float3& a, const Float3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Foot and normal of a place, from the origin of its cell.
struct PlacedFoot {
  openvdb::Coord origin;
  Float3 foot, normal;
};

PlacedFoot placedFoot(const FootBins& bins, const FootPlace& at) {
  if (at.cell->kind != CellKind::kNewton) {
    const TriangleCell& cell = bins.triangle(*at.cell);
    const auto& [p, q, r] = cell.points;
    Float3 foot;
    for (std::size_t k = 0; k < 3; ++k)
      foot[k] = p[k] + at.a * (q[k] - p[k]) + at.b * (r[k] - p[k]);
    return {cell.prism.origin, foot, normalAt(bins, at)};
  }
  const NewtonCell& cell = bins.newton(*at.cell);
  return {cell.prism.origin, Jet(cell.surface, at.a, at.b).s, normalAt(bins, at)};
}

/// Outward unit normal of the plane that stands for the surface near a voxel: the normal of the
/// surface, or at edges and boundaries the direction between the foot and the voxel's centre.
/// @param distance  of the voxel's centre from the surface; negative on the inner side
Vec3d planeNormal(const FootBins& bins, const FootPlace& at, const openvdb::Coord& voxel,
                  double distance) {
  const PlacedFoot placed = placedFoot(bins, at);
  const openvdb::Coord step = voxel - placed.origin;
  const Float3 fromFoot = difference(
      {static_cast<float>(step[0]), static_cast<float>(step[1]), static_cast<float>(step[2])},
      placed.foot);
  const Vec3d toVoxel(fromFoot[0], fromFoot[1], fromFoot[2]);
  const Vec3d normal =
      Vec3d(placed.normal[0], placed.normal[1], placed.normal[2]).stableNormalized();
  constexpr double kLeastDistance = 0.02;  // below, the direction of the foot is not precise
  constexpr double kMostAside = 0.1;       // sine of the angle between both
  const double away = toVoxel.norm();
  const double aside = normal.cross(toVoxel).norm();
  const bool useNormal = away < kLeastDistance || aside < kMostAside * away;
  if (useNormal && !normal.isZero(0))
    return normal.dot(toVoxel) * distance < 0 ? Vec3d(-normal) : normal;
  return away > 0 ? Vec3d(std::copysign(1 / away, distance) * toVoxel) : Vec3d(0, 0, 1);
}

using VisitLeafFeet = std::function<void(const FootBins&, const openvdb::Coord&, const LeafFeet&)>;

using FacesOfSurfaces = std::vector<std::vector<Index>>;

/// Bodies in groups. Of a group no two meet, if there are not too many: so the bodies that meet at
/// a voxel have a foot each.
class BodyGroups {
 public:
  explicit BodyGroups(std::size_t surfaces) : surfaces_(surfaces) {}

  void add(std::size_t surface, const PolygonMesh& mesh, const MeshComponent& body) {
    constexpr std::size_t kMostGroups = 8;
    constexpr std::size_t kMostBoxes = 1000;  // of a group
    const Box box = boxOf(mesh, body.faces);
    std::size_t g = 0;
    while (g < groups_.size() && g + 1 < kMostGroups && meets(boxes_[g], box)) ++g;
    if (g == groups_.size()) {
      groups_.emplace_back(surfaces_);
      boxes_.emplace_back();
    }
    if (boxes_[g].size() < kMostBoxes) boxes_[g].push_back(box);
    auto& faces = groups_[g][surface];
    const auto middle = static_cast<std::ptrdiff_t>(faces.size());
    faces.insert(faces.end(), body.faces.begin(), body.faces.end());
    std::inplace_merge(faces.begin(), faces.begin() + middle, faces.end());
  }

  const std::vector<FacesOfSurfaces>& faces() const { return groups_; }

 private:
  static bool meets(const std::vector<Box>& boxes, const Box& box) {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& other) { return other.meets(box); });
  }

  std::size_t surfaces_;
  std::vector<FacesOfSurfaces> groups_;
  std::vector<std::vector<Box>> boxes_;
};

using MaskLeaf = openvdb::MaskTree::LeafNodeType;

/// The solid voxels at the place of a leaf, which may be a tile.
class SolidLeaf {
 public:
  SolidLeaf(const openvdb::MaskTree& solid, const openvdb::Coord& origin)
      : leaf_(solid.probeConstLeaf(origin)), tile_(leaf_ == nullptr && solid.isValueOn(origin)) {}
  bool isOn(unsigned voxel) const { return leaf_ != nullptr ? leaf_->isValueOn(voxel) : tile_; }

 private:
  const MaskLeaf* leaf_;
  bool tile_;
};

class SoftDensity {
 public:
  SoftDensity(const openvdb::MaskTree& mask, std::span<const PreparedSurface> surfaces, float value,
              MemoryBudget& budget, Progress& progress)
      : mask_(mask),
        surfaces_(surfaces),
        value_(value),
        budget_(budget),
        progress_(progress),
        near_(mask) {
    grow(near_);
    if (!surfaces.empty()) crop(near_, surfaces[0].region);
  }

  openvdb::FloatTree::Ptr shells() {
    budget_.take(bytesOfFloats(near_), "the density grid", kScatteredAdvice);
    tree_ = std::make_shared<openvdb::FloatTree>(near_, 0.0F, openvdb::TopologyCopy());
    FacesOfSurfaces all;
    for (const PreparedSurface& surface : surfaces_)
      all.push_back(numbered(surface.base.mesh.faceCount()));
    addShells(all, 1);
    switchOffEmpty();
    openvdb::tools::pruneInactive(*tree_);
    return tree_;
  }

  openvdb::FloatTree::Ptr solid(const VolumeSettings& settings,
                                std::vector<std::string>& warnings) {
    budget_.require(bytesOfFilling(mask_), "the inside", kScatteredAdvice);
    solid_ = solidOf(mask_, surfaces_, settings, budget_, progress_, warnings).voxels;
    BodyGroups groups(surfaces_.size());
    FacesOfSurfaces sheets;
    bool anySheet = false;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      BodiesAndSheets parts = bodiesAndSheets(surfaces_[i], {&mask_, solid_.get()}, progress_);
      for (const MeshComponent& body : parts.bodies) groups.add(i, surfaces_[i].base.mesh, body);
      anySheet |= !parts.sheets.empty();
      sheets.push_back(std::move(parts.sheets));
    }
    makeSolidTree();
    const double part = (anySheet ? 0.7 : 1) / static_cast<double>(groups.faces().size());
    const float reach = groups.faces().size() > 1 ? kReachOfSolids : kReachOfSolid;
    for (const FacesOfSurfaces& faces : groups.faces()) addBodies(faces, reach, part);
    if (!crossings_.empty()) uniteAtCrossings(groups.faces());
    decideUnknown();
    if (anySheet) addShells(sheets, 0.3);
    switchOffEmpty();
    openvdb::tools::prune(*tree_);
    return tree_;
  }

 private:
  /// `value` at solid voxels, but kUnknown near the surface; there `value` only at enclosed voxels.
  void makeSolidTree() {
    openvdb::MaskTree all(near_);
    all.topologyUnion(*solid_);
    budget_.take(bytesOfFloats(all), "the density grid", kScatteredAdvice);
    tree_ = std::make_shared<openvdb::FloatTree>(*solid_, 0.0F, value_, openvdb::TopologyCopy());
    tree_->topologyUnion(near_);
    forEachLeafNear([&](const MaskLeaf& near, const MaskLeaf*, float* values) {
      const openvdb::tree::ValueAccessor<const openvdb::MaskTree> solid(*solid_);
      for (auto voxel = near.cbeginValueOn(); voxel; ++voxel)
        if (!isEnclosed(solid, voxel.getCoord())) values[voxel.pos()] = kUnknown;
    });
  }

  /// Decides the voxels that no part of the surface of the whole comes near: they are inside or
  /// outside, as their neighbours are.
  void decideUnknown() {
    forEachLeafNear([&](const MaskLeaf& near, const MaskLeaf* mask, float* values) {
      const SolidLeaf solid(*solid_, near.origin());
      for (auto voxel = near.cbeginValueOn(); voxel; ++voxel) {
        float& value = values[voxel.pos()];
        const bool crossed = mask != nullptr && mask->isValueOn(voxel.pos());
        if (value == kUnknown && !crossed) value = solid.isOn(voxel.pos()) ? value_ : 0;
      }
    });
    std::vector<openvdb::Coord> unknown;
    std::vector<const MaskLeaf*> leaves;
    std::as_const(near_).getNodes(leaves);
    for (const MaskLeaf* leaf : leaves) {
      const float* const values = tree_->probeConstLeaf(leaf->origin())->buffer().data();
      for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
        if (values[voxel.pos()] == kUnknown) unknown.push_back(voxel.getCoord());
    }
    while (!unknown.empty()) unknown = undecidedOf(unknown);
  }

  /// Decides the unknown voxels that have a neighbour with a value.
  /// @return  the others; none if there would be no progress
  std::vector<openvdb::Coord> undecidedOf(const std::vector<openvdb::Coord>& unknown) {
    std::vector<float> decided(unknown.size(), kUnknown);
    parallelForEach(unknown.size(), 1024, [&](std::size_t i) {
      const openvdb::tree::ValueAccessor<const openvdb::FloatTree> values(*tree_);
      int inside = 0;
      int outside = 0;
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          openvdb::Coord next = unknown[i];
          next[axis] += step;
          const float value = values.getValue(next);
          if (value != kUnknown) ++(2 * value > value_ ? inside : outside);
        }
      if (inside + outside > 0) decided[i] = inside >= outside ? value_ : 0;
    });
    std::vector<openvdb::Coord> left;
    openvdb::tree::ValueAccessor<openvdb::FloatTree> values(*tree_);
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (decided[i] == kUnknown)
        left.push_back(unknown[i]);
      else
        values.setValueOnly(unknown[i], decided[i]);
    if (left.size() < unknown.size()) return left;
    for (const openvdb::Coord& voxel : left) values.setValueOnly(voxel, value_);
    return {};
  }

  /// Calls visit(leaf of near_, leaf of the mask or null, values).
  template <class Visit>
  void forEachLeafNear(Visit&& visit) {
    std::vector<const MaskLeaf*> leaves;
    std::as_const(near_).getNodes(leaves);
    parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
      progress_.check();
      const openvdb::Coord origin = leaves[l]->origin();
      visit(*leaves[l], mask_.probeConstLeaf(origin), tree_->probeLeaf(origin)->buffer().data());
    });
  }

  /// Raises values to the parts of the voxels in some bodies. Notes the voxels in which the
  /// surfaces of two groups of bodies cross.
  void addBodies(const FacesOfSurfaces& faces, float reach, double part) {
    tbb::enumerable_thread_specific<std::vector<openvdb::Coord>> crossings;
    visitPlanesOf(near_, faces, reach, part,
                  [&](openvdb::FloatTree::LeafNodeType& leaf, unsigned i, double distance,
                      const Vec3d& normal) {
                    float& value = leaf.buffer().data()[i];
                    if (value == value_) return;
                    const float next = scaled(coverage(distance, normal));
                    if (value > 0 && value < value_ && next > 0 && next < value_)
                      crossings.local().push_back(globalOf(leaf, i));
                    value = std::max(value, next);
                  });
    for (const auto& voxels : crossings)
      for (const openvdb::Coord& voxel : voxels) crossings_.setValueOn(voxel);
  }

  /// Sets the values of voxels in which surfaces of bodies cross to the part in any of the bodies.
  void uniteAtCrossings(const std::vector<FacesOfSurfaces>& groups) {
    openvdb::Int64Tree samples(crossings_, 0, openvdb::TopologyCopy());
    for (auto leaf = crossings_.cbeginLeaf(); leaf; ++leaf)
      for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
        tree_->setValueOnly(voxel.getCoord(), 0);
    for (const FacesOfSurfaces& faces : groups)
      visitPlanesOf(crossings_, faces, kReachOfSolids, 0,
                    [&](openvdb::FloatTree::LeafNodeType& leaf, unsigned i, double distance,
                        const Vec3d& normal) {
                      auto& united = samples.probeLeaf(leaf.origin())->buffer().data()[i];
                      const auto before = static_cast<std::uint64_t>(united);
                      const std::uint64_t below = samplesBelow(distance, normal);
                      float& value = leaf.buffer().data()[i];
                      value = scaled(unitedPart(double{value / value_}, before,
                                                coverage(distance, normal), below));
                      united = static_cast<openvdb::Int64>(before | below);
                    });
  }

  using VisitPlane = std::function<void(openvdb::FloatTree::LeafNodeType&, unsigned voxel,
                                        double distance, const Vec3d& normal)>;
  /// Visits the planes that stand for the surfaces of some bodies at voxels.
  void visitPlanesOf(const openvdb::MaskTree& voxels, const FacesOfSurfaces& faces, float reach,
                     double part, const VisitPlane& visit) {
    visitFeetOf(voxels, faces, reach, part,
                [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                  const MaskLeaf* mask = mask_.probeConstLeaf(origin);
                  const SolidLeaf solid(*solid_, origin);
                  auto* leaf = tree_->probeLeaf(origin);
                  feet.forEachFound([&](unsigned i) {
                    double distance = double{feet.distance[i]};
                    const bool crossed = mask != nullptr && mask->isValueOn(i);
                    if (!crossed && std::abs(distance) >= kCertainSide)
                      distance = std::copysign(distance, solid.isOn(i) ? -1.0 : 1.0);
                    if (distance > double{kReachOfSolid}) return;
                    const openvdb::Coord voxel = globalOf(*leaf, i);
                    const Vec3d normal = planeNormal(bins, feet.place[i], voxel, distance);
                    if (distance < -kReachOfCube && !isSolidBelow(voxel, normal)) return;
                    visit(*leaf, i, distance, normal);
                  });
                });
  }

  /// Whether the next voxel inward is solid, too. Near a wall without thickness, a foot beyond the
  /// voxel's cube may have the voxel on its inner side and yet not enclose it.
  bool isSolidBelow(const openvdb::Coord& voxel, const Vec3d& normal) const {
    return solid_->isValueOn(voxel - openvdb::Coord::round(openvdb::Vec3d(normal.data())));
  }

  void addShells(const FacesOfSurfaces& faces, double part) {
    visitFeetOf(near_, faces, kReachOfShell, part,
                [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                  auto* leaf = tree_->probeLeaf(origin);
                  float* const values = leaf->buffer().data();
                  feet.forEachFound([&](unsigned i) {
                    const double distance = double{feet.distance[i]};
                    const Vec3d normal =
                        planeNormal(bins, feet.place[i], globalOf(*leaf, i), distance);
                    values[i] = std::max(values[i], scaled(shellCoverage(distance, normal)));
                  });
                });
  }

  /// Visits the feet of voxels on some faces of each surface.
  void visitFeetOf(const openvdb::MaskTree& voxels, const FacesOfSurfaces& faces, float reach,
                   double part, const VisitLeafFeet& visit) {
    constexpr double kPartOfCells = 0.3;
    FootCells cells({.reach = reach,
                     .polynomials = false,
                     .tolerance = {.small = 0.02, .large = 0.01},
                     .newtonStop = 0.02F},
                    &voxels == &near_ ? std::vector<openvdb::Coord>{} : binsOf(voxels), budget_);
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      if (!faces[s].empty())
        addCells(surfaces_[s], faces[s],
                 kPartOfCells * part / static_cast<double>(surfaces_.size()), cells);
    const FootBins bins = cells.bins();
    forEachFoot(
        bins, voxels, progress_, (1 - kPartOfCells) * part,
        [&](const openvdb::Coord& origin, const LeafFeet& feet) { visit(bins, origin, feet); });
  }

  void addCells(const PreparedSurface& surface, const std::vector<Index>& faces, double part,
                FootCells& cells) const {
    if (levelOf(surface.way))
      return cells.addTriangles(trianglesOfLevel(surface, faces, budget_, progress_), progress_);
    cells.addLimitSurface(surface, faces, {}, progress_, part);
  }

  void switchOffEmpty() {
    std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
    tree_->getNodes(leaves);
    parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
      for (auto voxel = leaves[l]->beginValueOn(); voxel; ++voxel)
        if (*voxel == 0) voxel.setValueOff();
    });
  }

  float scaled(double part) const {
    constexpr double kLeastPart = 1e-6;
    return part < kLeastPart ? 0 : static_cast<float>(part * double{value_});
  }
  static openvdb::Coord globalOf(const openvdb::FloatTree::LeafNodeType& leaf, unsigned voxel) {
    return leaf.offsetToGlobalCoord(voxel);
  }

  static constexpr std::size_t kLeavesPerTask = 64;
  static constexpr float kUnknown = -1;
  /// Within this distance, in voxels, the side of the closest point is that of the voxel.
  static constexpr double kCertainSide = 0.5;

  const openvdb::MaskTree& mask_;
  std::span<const PreparedSurface> surfaces_;
  float value_;
  MemoryBudget& budget_;
  Progress& progress_;
  openvdb::MaskTree near_;       // the voxels that may have a soft value
  openvdb::MaskTree crossings_;  // voxels in which the surfaces of bodies cross
  openvdb::MaskTree::ConstPtr solid_;
  openvdb::FloatTree::Ptr tree_;
};

}  // namespace

openvdb::FloatGrid::Ptr softDensityGrid(const openvdb::MaskTree& mask,
                                        std::span<const PreparedSurface> surfaces,
                                        const VolumeSettings& settings, float value,
                                        MemoryBudget& budget, Progress& progress,
                                        std::vector<std::string>& warnings) {
  SoftDensity density(mask, surfaces, value, budget, progress);
  auto grid = densityGrid(settings.fill == Fill::kSolid ? density.solid(settings, warnings)
                                                        : density.shells());
  grid->insertMeta(kEdgeMetadata, openvdb::StringMetadata("soft"));
  return grid;
}

openvdb::MaskGrid::Ptr softVoxels(const openvdb::FloatGrid& density,
                                  const openvdb::MaskGrid& mask) {
  auto voxels = std::make_shared<openvdb::MaskTree>(mask.tree());
  grow(*voxels);
  voxels->topologyIntersection(density.tree());
  openvdb::tools::pruneInactive(*voxels);
  auto grid = openvdb::MaskGrid::create(voxels);
  grid->setTransform(mask.transform().copy());
  return grid;
}

}  // namespace vox
