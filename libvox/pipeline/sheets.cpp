// Which components of an object are sheets.

#include "libvox/pipeline/sheets.h"

#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/patch.h"
#include "libvox/pipeline/foot_cells.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

namespace vox {
namespace {

/// Counts on how many pieces the inner side is solid beyond the voxels that surfaces cross.
class InnerSideVotes : public LimitSink {
 public:
  struct Count {
    std::atomic<std::uint64_t> solid = 0, all = 0;
  };
  InnerSideVotes(const openvdb::MaskTree& active, const openvdb::MaskTree& solid, Count& count)
      : active_(active), solid_(solid), count_(count) {}

  void piece(const LimitPiece& piece) override {
    const auto& p = piece.points;
    const Vec3d normal = normalOfTangents(p[2][1] - p[0][1], p[1][2] - p[1][0]);
    const Vec3d inner = p[1][1] - 2 * normal;
    const auto voxel = openvdb::Coord::round(openvdb::Vec3d(inner.data()));
    if (active_.isValueOn(voxel)) return;
    ++count_.all;
    if (solid_.isValueOn(voxel)) ++count_.solid;
  }

 private:
  const openvdb::MaskTree& active_;
  const openvdb::MaskTree& solid_;
  Count& count_;
};

bool enclosesSomething(const PreparedSurface& surface, const MeshComponent& component,
                       const openvdb::MaskTree& active, const openvdb::MaskTree& solid,
                       Progress& progress) {
  if (component.side != MeshComponent::Side::kNoInside) return true;
  InnerSideVotes::Count count;
  const auto vote = [&](LimitSink&) {
    return std::make_unique<InnerSideVotes>(active, solid, count);
  };
  FootCells none({.reach = 0});
  none.addLimitSurface(surface, component.faces, vote, progress, 0);
  return 2 * count.solid > count.all;
}

}  // namespace

BodiesAndSheets bodiesAndSheets(const PreparedSurface& surface, const openvdb::MaskTree& active,
                                const openvdb::MaskTree& solid, Progress& progress) {
  BodiesAndSheets result;
  for (MeshComponent& component : componentsOf(surface.base))
    if (enclosesSomething(surface, component, active, solid, progress))
      result.bodies.push_back(std::move(component));
    else
      result.sheets.insert(result.sheets.end(), component.faces.begin(), component.faces.end());
  std::sort(result.sheets.begin(), result.sheets.end());
  return result;
}

}  // namespace vox
