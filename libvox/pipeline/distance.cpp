// The level set of all objects: cells of their surfaces, and what is inside.

#include "libvox/pipeline/distance.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/foot/band.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/patch.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/exposed_pieces.h"
#include "libvox/pipeline/foot_cells.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/volume/fill.h"

#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

namespace vox {
namespace {

/// A component of an object.
struct Part {
  std::size_t surface;
  const MeshComponent* component;
  Box box;  // of its control points, which hold the surface; index space

  bool isClosed() const { return component->side != MeshComponent::Side::kNoInside; }
};

Box boxOf(const PolygonMesh& mesh, const MeshComponent& component) {
  Box box;
  for (const Index f : component.faces)
    for (const Index v : mesh.face(f)) box.add(mesh.points[v]);
  return box;
}

/// Whether surfaces of components could touch, or lie in each other.
bool mayMeet(const std::vector<Part>& parts) {
  constexpr std::size_t kMostCompared = 1000;
  if (parts.size() > kMostCompared) return true;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((parts[i].box.low.array() <= parts[j].box.high.array()).all() &&
          (parts[j].box.low.array() <= parts[i].box.high.array()).all())
        return true;
  return false;
}

bool facesInward(const Part& part) { return part.component->side == MeshComponent::Side::kIn; }

/// Counts how often the inner side of a surface is solid beyond the voxels that it crosses.
class InnerSide : public LimitSink {
 public:
  struct Votes {
    std::atomic<std::uint64_t> solid = 0, all = 0;
  };
  InnerSide(const openvdb::MaskTree& surface, const openvdb::MaskTree& solid, Votes& votes)
      : surface_(surface), solid_(solid), votes_(votes) {}

  void piece(const LimitPiece& piece) override {
    const auto& p = piece.points;
    const Vec3d normal = normalOfTangents(p[2][1] - p[0][1], p[1][2] - p[1][0]);
    const Vec3d inner = p[1][1] - 2 * normal;
    const auto voxel = openvdb::Coord::round(openvdb::Vec3d(inner.data()));
    if (surface_.isValueOn(voxel)) return;
    ++votes_.all;
    if (solid_.isValueOn(voxel)) ++votes_.solid;
  }

 private:
  const openvdb::MaskTree& surface_;
  const openvdb::MaskTree& solid_;
  Votes& votes_;
};

class LevelSetMaker {
 public:
  LevelSetMaker(std::span<const PreparedSurface> surfaces, const VolumeSettings& settings,
                double voxelSize, const MarkVoxels& markVoxels, MemoryBudget& budget,
                Progress& progress)
      : surfaces_(surfaces),
        settings_(settings),
        voxelSize_(voxelSize),
        markVoxels_(markVoxels),
        budget_(budget),
        progress_(progress) {
    for (const PreparedSurface& surface : surfaces)
      components_.push_back(componentsOf(surface.base));
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      for (const MeshComponent& component : components_[s]) {
        const Part part{s, &component, boxOf(surfaces[s].base.mesh, component)};
        (part.isClosed() ? closed_ : open_).push_back(part);
      }
  }

  openvdb::FloatTree::Ptr make() {
    if (!open_.empty()) findEnclosing();
    openvdb::FloatTree::Ptr tree;
    if (!closed_.empty()) tree = bandOfSolids();
    if (!open_.empty()) {
      const openvdb::FloatTree::Ptr sheets = bandOfSheets();
      if (tree)
        openvdb::tools::csgUnion(*tree, *sheets);
      else
        tree = sheets;
    }
    return tree;
  }

  bool hasSheets() const { return !open_.empty(); }

 private:
  static constexpr const char* kAdvice = "use a smaller --band or larger voxels, or raise --max-memory";

  /// Open components that enclose something become closed ones.
  void findEnclosing() {
    findInside();
    std::vector<Part> sheets;
    for (const Part& part : open_) {
      InnerSide::Votes votes;
      FootCells none({.reach = 0});
      none.addLimitSurface(
          surfaces_[part.surface], part.component->faces,
          [&](LimitSink&) {
            return std::make_unique<InnerSide>(*inside_.surface, *inside_.solid, votes);
          },
          progress_, 0);
      (2 * votes.solid > votes.all ? closed_ : sheets).push_back(part);
    }
    open_ = std::move(sheets);
  }

  void findInside() {
    if (inside_.solid != nullptr) return;
    inside_.surface = &markVoxels_();
    budget_.require(bytesOfFilling(*inside_.surface), "the inside", kScatteredAdvice);
    solid_ = solidOf(*inside_.surface, surfaces_, budget_, progress_);
    inside_.solid = solid_.get();
  }

  openvdb::FloatTree::Ptr bandOfSolids() {
    constexpr double kFirst = 0.9;  // share of the stage
    const BandOptions options{settings_.band, settings_.band, voxelSize_};
    const bool overlap =
        mayMeet(closed_) || std::any_of(closed_.begin(), closed_.end(), facesInward);
    if (!overlap && inside_.solid == nullptr) {
      Band band = bandOf(closed_, options, false, kFirst);
      if (band.jumps == 0) return band.tree;
    }
    findInside();
    return bandOf(closed_, options, true, overlap || !open_.empty() ? kFirst : 1 - kFirst).tree;
  }

  openvdb::FloatTree::Ptr bandOfSheets() {
    constexpr double kHalfThickness = 0.5;
    const double half = settings_.openMesh == OpenMesh::kUnsigned ? 0 : kHalfThickness;
    return bandOf(open_, {settings_.band, settings_.band, voxelSize_, true, half}, false,
                  closed_.empty() ? 1 : 0.1)
        .tree;
  }

  /// @param byVoxels  whether voxels decide what is inside
  /// @param share     of the stage
  Band bandOf(const std::vector<Part>& parts, const BandOptions& options, bool byVoxels,
              double share) {
    constexpr double kPartOfCells = 0.3;
    FootCells cells(
        {.reach = static_cast<float>(std::max(options.in, options.out) + options.halfThickness)});
    for (auto begin = parts.begin(); begin != parts.end();) {
      const std::size_t s = begin->surface;
      std::vector<Index> faces;
      for (; begin != parts.end() && begin->surface == s; ++begin)
        faces.insert(faces.end(), begin->component->faces.begin(), begin->component->faces.end());
      addCells(surfaces_[s], std::move(faces), byVoxels,
               kPartOfCells * share / static_cast<double>(surfaces_.size()), cells);
    }
    budget_.require(cells.bytes(), "the cells of the surface", kAdvice);
    return makeBand(cells.bins(), options, byVoxels ? inside_ : Inside{}, progress_,
                    (1 - kPartOfCells) * share);
  }

  void addCells(const PreparedSurface& surface, std::vector<Index> faces, bool byVoxels,
                double share, FootCells& cells) const {
    std::sort(faces.begin(), faces.end());
    if (levelOf(surface.way))
      return cells.addTriangles(trianglesOfLevel(surface, faces, budget_, progress_), progress_);
    if (faces.size() == surface.base.mesh.faceCount()) faces.clear();
    PieceFilter filter;
    if (byVoxels)
      filter = [this](LimitSink& next) {
        return std::make_unique<ExposedPieces>(*inside_.solid, next);
      };
    cells.addLimitSurface(surface, faces, filter, progress_, share);
  }

  std::span<const PreparedSurface> surfaces_;
  const VolumeSettings& settings_;
  double voxelSize_;
  const MarkVoxels& markVoxels_;
  MemoryBudget& budget_;
  Progress& progress_;
  std::vector<std::vector<MeshComponent>> components_;
  std::vector<Part> closed_, open_;
  openvdb::MaskTree::Ptr solid_;
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
                                    const MarkVoxels& markVoxels, MemoryBudget& budget,
                                    Progress& progress, std::vector<std::string>& warnings) {
  const double voxelSize = transform.voxelSize()[0];
  LevelSetMaker maker(surfaces, settings, voxelSize, markVoxels, budget, progress);
  auto grid = openvdb::FloatGrid::create(maker.make());
  grid->setTransform(transform.copy());
  const bool isUnsigned = maker.hasSheets() && settings.openMesh == OpenMesh::kUnsigned;
  grid->setGridClass(isUnsigned ? openvdb::GRID_UNKNOWN : openvdb::GRID_LEVEL_SET);
  if (!maker.hasSheets() && isThin(grid->tree(), voxelSize))
    warnings.push_back(
        "the objects are thinner than a voxel everywhere: the level set has hardly any inside; use "
        "smaller voxels");
  budget.take(grid->memUsage(), "the surface grid", kScatteredAdvice);
  return grid;
}

}  // namespace vox
