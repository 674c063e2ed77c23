// Which components of an object are sheets.

#include "libvox/pipeline/sheets.h"

#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/patch.h"
#include "libvox/pipeline/run_submeshes.h"
#include "libvox/subdivide/limit_walk.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

namespace vox {
namespace {

/// On how many pieces the inner side of a component is solid, beyond the voxels that surfaces
/// cross.
struct Votes {
  std::atomic<std::uint64_t> solid = 0, all = 0;
};

/// Counts the votes of components.
class InnerSide : public LimitSink {
 public:
  /// @param componentOf  number of the component of each corner
  InnerSide(const Inside& inside, std::span<const Index> componentOf, std::span<Votes> votes)
      : inside_(inside), componentOf_(componentOf), votes_(votes) {}

  void piece(const LimitPiece& piece) override {
    constexpr double kBeyondSurface = 2;  // voxels
    const auto& p = piece.points;
    const Vec3d normal = normalOfTangents(p[2][1] - p[0][1], p[1][2] - p[1][0]);
    const Vec3d inner = p[1][1] - kBeyondSurface * normal;
    const auto voxel = openvdb::Coord::round(openvdb::Vec3d(inner.data()));
    if (inside_.surface->isValueOn(voxel)) return;
    Votes& votes = votes_[componentOf_[piece.square.corner]];
    ++votes.all;
    if (inside_.solid->isValueOn(voxel)) ++votes.solid;
  }

 private:
  const Inside& inside_;
  std::span<const Index> componentOf_;
  std::span<Votes> votes_;
};

bool isClosed(const MeshComponent& component) {
  return component.side != MeshComponent::Side::kNoInside;
}

}  // namespace

std::vector<bool> haveInside(const PreparedSurface& surface,
                             std::span<const MeshComponent> components, const Inside& inside,
                             Progress& progress) {
  std::vector<bool> have(components.size());
  std::transform(components.begin(), components.end(), have.begin(), isClosed);
  if (std::find(have.begin(), have.end(), false) == have.end()) return have;
  const PolygonMesh& mesh = surface.base.mesh;
  std::vector<Index> componentOf(mesh.cornerCount());
  for (std::size_t i = 0; i < components.size(); ++i)
    for (const Index f : components[i].faces)
      std::fill_n(componentOf.begin() + mesh.faceOffsets[f], mesh.faceSize(f),
                  static_cast<Index>(i));
  std::vector<Votes> votes(components.size());
  InnerSide count(inside, componentOf, votes);
  constexpr double kCoarse = 0.25;  // voxels
  runSubmeshes(
      cutIntoSubmeshes(surface.base, surface.options), progress, 0,
      [&] {
        return std::make_unique<LimitWalk>(surface.base, PieceTolerance{kCoarse, kCoarse});
      },
      [&](const std::unique_ptr<LimitWalk>& walk, const SubmeshTask& task) {
        walk->emit(task.faces, count);
      });
  constexpr double kMostHoles = 0.5;  // share of the pieces
  for (std::size_t i = 0; i < components.size(); ++i)
    if (!have[i]) {
      const auto all = static_cast<double>(votes[i].all);
      have[i] = all > 0 && static_cast<double>(votes[i].solid) >= (1 - kMostHoles) * all;
    }
  return have;
}

BodiesAndSheets bodiesAndSheets(const PreparedSurface& surface, const Inside& inside,
                                Progress& progress) {
  std::vector<MeshComponent> components = componentsOf(surface.base);
  const std::vector<bool> have = haveInside(surface, components, inside, progress);
  BodiesAndSheets parts;
  for (std::size_t i = 0; i < components.size(); ++i)
    if (have[i])
      parts.bodies.push_back(std::move(components[i]));
    else
      parts.sheets.insert(parts.sheets.end(), components[i].faces.begin(),
                          components[i].faces.end());
  std::sort(parts.sheets.begin(), parts.sheets.end());
  return parts;
}

std::vector<openvdb::Coord> sheetVoxels(const Inside& inside, const openvdb::FloatTree& band,
                                        double voxelSize) {
  constexpr int kThickest = 3;  // voxels: that many a sheet may have one behind the other
  const double near = voxelSize;
  std::vector<openvdb::Coord> left;
  for (auto leaf = band.cbeginLeaf(); leaf; ++leaf) {
    const auto* const crossed = inside.surface->probeConstLeaf(leaf->origin());
    if (crossed == nullptr) continue;
    for (auto voxel = crossed->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Index i = voxel.pos();
      const bool ofBody = leaf->isValueOn(i) && std::abs(double{leaf->getValue(i)}) <= near;
      if (!ofBody && inside.solid->isValueOn(voxel.getCoord())) left.push_back(voxel.getCoord());
    }
  }
  openvdb::MaskTree solid(*inside.solid);
  std::vector<openvdb::Coord> found;
  for (int layer = 0; layer < kThickest; ++layer) {
    const auto isHidden = [&](const openvdb::Coord& voxel) {
      for (int i = 0; i < 6; ++i) {
        openvdb::Coord next = voxel;
        next[i / 2] += i % 2 == 0 ? 1 : -1;
        if (!solid.isValueOn(next)) return false;
      }
      return true;
    };
    const auto begin = std::partition(left.begin(), left.end(), isHidden);
    for (auto voxel = begin; voxel != left.end(); ++voxel) solid.setValueOff(*voxel);
    found.insert(found.end(), begin, left.end());
    left.erase(begin, left.end());
  }
  return found;
}

}  // namespace vox
