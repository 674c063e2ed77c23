// The part of each voxel that is inside, or near a surface.

#include "libvox/pipeline/soft_density.h"

#include "libvox/core/memory.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/nearest_feet.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/exposed_pieces.h"
#include "libvox/pipeline/foot_cells.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/sheets.h"
#include "libvox/volume/coverage.h"
#include "libvox/volume/density.h"
#include "libvox/volume/fill.h"

#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vox {
namespace {

// The cubes that a plane crosses are nearer than sqrt(3) / 2, and vertices that switched voxels on may
// lie a little off the limit surface.
constexpr float kReachOfSolid = 1.1F;
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
  if (at.cell->kind == CellKind::kTriangle) {
    const TriangleCell& cell = bins.triangle(*at.cell);
    const auto& [p, q, r] = cell.points;
    Float3 foot;
    for (std::size_t k = 0; k < 3; ++k)
      foot[k] = p[k] + at.a * (q[k] - p[k]) + at.b * (r[k] - p[k]);
    return {cell.prism.origin, foot, cell.normal};
  }
  const NewtonCell& cell = bins.newton(*at.cell);
  const Jet jet(cell.surface, at.a, at.b);
  return {cell.prism.origin, jet.s, jet.normal()};
}

/// Unit normal, of any sign, of the plane that stands for the surface near a voxel: the normal of the
/// surface, or at edges and boundaries the direction from the foot to the voxel's centre.
Vec3d planeNormal(const FootBins& bins, const FootPlace& at, const openvdb::Coord& voxel) {
  const PlacedFoot placed = placedFoot(bins, at);
  const openvdb::Coord step = voxel - placed.origin;
  const Float3 away = difference({static_cast<float>(step[0]), static_cast<float>(step[1]),
                                  static_cast<float>(step[2])},
                                 placed.foot);
  const Vec3d toVoxel(away[0], away[1], away[2]);
  const Vec3d normal =
      Vec3d(placed.normal[0], placed.normal[1], placed.normal[2]).stableNormalized();
  constexpr double kLeastDistance = 0.02;  // below, the direction of the foot is not precise
  constexpr double kMostAside = 0.1;       // sine of the angle between both
  const double distance = toVoxel.norm();
  const double aside = normal.cross(toVoxel).norm();
  const bool useNormal = distance < kLeastDistance || aside < kMostAside * distance;
  if (useNormal && !normal.isZero(0)) return normal;
  return distance > 0 ? Vec3d(toVoxel / distance) : Vec3d(0, 0, 1);
}

using VisitLeafFeet =
    std::function<void(const FootBins&, const openvdb::Coord&, const LeafFeet&)>;

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
    openvdb::tools::dilateActiveValues(near_, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
  }

  openvdb::FloatTree::Ptr shells() {
    budget_.take(bytesOfFloats(near_), "the density grid", kScatteredAdvice);
    tree_ = std::make_shared<openvdb::FloatTree>(near_, 0.0F, openvdb::TopologyCopy());
    std::vector<std::vector<Index>> all;
    for (const PreparedSurface& surface : surfaces_)
      all.push_back(numbered(surface.base.mesh.faceCount()));
    addShells(all, 1);
    switchOffEmpty();
    openvdb::tools::pruneInactive(*tree_);
    return tree_;
  }

  openvdb::FloatTree::Ptr solid() {
    budget_.require(bytesOfFilling(mask_), "the inside", kScatteredAdvice);
    solid_ = solidOf(mask_, surfaces_, budget_, progress_);
    std::vector<std::vector<Index>> bodies, sheets;
    bool anySheet = false;
    for (const PreparedSurface& surface : surfaces_) {
      SolidAndSheets parts = solidAndSheets(surface, mask_, *solid_, progress_);
      anySheet |= !parts.sheets.empty();
      bodies.push_back(std::move(parts.solid));
      sheets.push_back(std::move(parts.sheets));
    }
    makeSolidTree();
    addBodies(bodies, anySheet ? 0.7 : 1);
    if (anySheet) addShells(sheets, 0.3);
    switchOffEmpty();
    openvdb::tools::prune(*tree_);
    return tree_;
  }

 private:
  /// `value` at solid voxels, but 0 at those that a surface crosses and that are not enclosed.
  void makeSolidTree() {
    openvdb::MaskTree all(near_);
    all.topologyUnion(*solid_);
    budget_.take(bytesOfFloats(all), "the density grid", kScatteredAdvice);
    tree_ = std::make_shared<openvdb::FloatTree>(*solid_, 0.0F, value_, openvdb::TopologyCopy());
    tree_->topologyUnion(near_);
    std::vector<const openvdb::MaskTree::LeafNodeType*> leaves;
    mask_.getNodes(leaves);
    parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
      progress_.check();
      openvdb::tree::ValueAccessor<const openvdb::MaskTree> solid(*solid_);
      float* const values = tree_->probeLeaf(leaves[l]->origin())->buffer().data();
      for (auto voxel = leaves[l]->cbeginValueOn(); voxel; ++voxel)
        if (!isEnclosed(solid, voxel.getCoord())) values[voxel.pos()] = 0;
    });
  }

  /// Whether all 26 neighbours are solid. Where a plane crosses voxels, each of them has a neighbour
  /// beyond all these voxels; so the surface in an enclosed voxel has no outside.
  template <class Accessor>
  static bool isEnclosed(const Accessor& solid, const openvdb::Coord& voxel) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (!solid.isValueOn(voxel.offsetBy(x, y, z))) return false;
    return true;
  }

  void addBodies(const std::vector<std::vector<Index>>& faces, double part) {
    visitFeetOf(faces, kReachOfSolid, true, part,
                [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                  const auto* mask = mask_.probeConstLeaf(origin);
                  const auto* solid = solid_->probeConstLeaf(origin);
                  const bool solidTile = solid == nullptr && solid_->isValueOn(origin);
                  auto* leaf = tree_->probeLeaf(origin);
                  float* const values = leaf->buffer().data();
                  feet.forEachFound([&](unsigned i) {
                    const bool crossed = mask != nullptr && mask->isValueOn(i);
                    if (crossed && values[i] != 0) return;  // enclosed
                    double distance = double{feet.distance[i]};
                    if (!crossed && std::abs(distance) >= kCertainSide) {
                      const bool inside = solid != nullptr ? solid->isValueOn(i) : solidTile;
                      distance = inside ? -std::abs(distance) : std::abs(distance);
                    }
                    values[i] = scaled(
                        coverage(distance, planeNormal(bins, feet.place[i], globalOf(*leaf, i))));
                  });
                });
  }

  void addShells(const std::vector<std::vector<Index>>& faces, double part) {
    visitFeetOf(faces, kReachOfShell, false, part,
                [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                  auto* leaf = tree_->probeLeaf(origin);
                  float* const values = leaf->buffer().data();
                  feet.forEachFound([&](unsigned i) {
                    const Vec3d normal = planeNormal(bins, feet.place[i], globalOf(*leaf, i));
                    values[i] = std::max(
                        values[i], scaled(shellCoverage(double{feet.distance[i]}, normal)));
                  });
                });
  }

  /// Visits the feet, on some faces of each surface, of all voxels near the active ones.
  /// @param onlyExposed  whether to leave out parts of surfaces within others
  void visitFeetOf(const std::vector<std::vector<Index>>& faces, float reach, bool onlyExposed,
                   double part, const VisitLeafFeet& visit) {
    constexpr double kPartOfCells = 0.3;
    FootCells cells({.reach = reach, .polynomials = false, .newtonStop = 0.02F});
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      if (!faces[s].empty())
        addCells(surfaces_[s], faces[s], onlyExposed,
                 kPartOfCells * part / static_cast<double>(surfaces_.size()), cells);
    budget_.require(cells.bytes(), "the cells of the surface",
                    "use larger voxels, or raise --max-memory");
    const FootBins bins = cells.bins();
    forEachFoot(bins, near_, progress_, (1 - kPartOfCells) * part,
                [&](const openvdb::Coord& origin, const LeafFeet& feet) {
                  visit(bins, origin, feet);
                });
  }

  void addCells(const PreparedSurface& surface, const std::vector<Index>& faces, bool onlyExposed,
                double part, FootCells& cells) const {
    if (levelOf(surface.way))
      return cells.addTriangles(trianglesOfLevel(surface, faces, budget_, progress_), progress_);
    PieceFilter filter;
    if (onlyExposed)
      filter = [this](LimitSink& next) { return std::make_unique<ExposedPieces>(*solid_, next); };
    const bool all = faces.size() == surface.base.mesh.faceCount();
    cells.addLimitSurface(surface, all ? std::vector<Index>{} : faces, filter, progress_, part);
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
  /// Within this distance, in voxels, the side of the closest point is that of the voxel.
  static constexpr double kCertainSide = 0.5;

  const openvdb::MaskTree& mask_;
  std::span<const PreparedSurface> surfaces_;
  float value_;
  MemoryBudget& budget_;
  Progress& progress_;
  openvdb::MaskTree near_;  // the voxels that may have a soft value
  openvdb::MaskTree::ConstPtr solid_;
  openvdb::FloatTree::Ptr tree_;
};

}  // namespace

openvdb::FloatGrid::Ptr softDensityGrid(const openvdb::MaskTree& mask,
                                        std::span<const PreparedSurface> surfaces, Fill fill,
                                        float value, MemoryBudget& budget, Progress& progress) {
  SoftDensity density(mask, surfaces, value, budget, progress);
  return densityGrid(fill == Fill::kSolid ? density.solid() : density.shells());
}

}  // namespace vox
