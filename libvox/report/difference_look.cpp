// What differs between two grids, as coloured voxels.

#include "libvox/report/difference_look.h"

#include "libvox/inspect/topology.h"
#include "libvox/report/palette.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;

/// Voxels of a level set within one voxel of the surface.
MaskTree::Ptr nearSurface(const openvdb::FloatGrid& levelSet) {
  const double most = levelSet.voxelSize().x();
  auto near = std::make_shared<MaskTree>();
  openvdb::tree::ValueAccessor<MaskTree> at(*near);
  for (auto value = levelSet.tree().cbeginValueOn(); value; ++value)
    if (value.isVoxelValue() && std::abs(*value) <= most) at.setValueOn(value.getCoord());
  return near;
}

MaskTree::Ptr shownVoxels(const openvdb::GridBase& grid) {
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET && grid.isType<openvdb::FloatGrid>())
    return nearSurface(static_cast<const openvdb::FloatGrid&>(grid));
  return topologyOf(grid);
}

/// The voxels of a tree in a box, one by one: the box must be small.
MaskTree::Ptr cut(const MaskTree& voxels, const CoordBBox& box) {
  auto part = std::make_shared<MaskTree>();
  const openvdb::tree::ValueAccessor<const MaskTree> at(voxels);
  for (auto voxel = box.begin(); voxel; ++voxel)
    if (at.isValueOn(*voxel)) part->setValueOn(*voxel);
  return part;
}

double largestFinite(const openvdb::FloatTree& values) {
  double largest = 0;
  for (auto value = values.cbeginValueOn(); value; ++value)
    if (std::isfinite(*value)) largest = std::max(largest, static_cast<double>(*value));
  return largest;
}

}  // namespace

DifferenceLook::DifferenceLook(const openvdb::GridBase& a, const openvdb::GridBase& b,
                               const DiffOptions& options)
    : difference_(differenceGrids(a, b, options)),
      all_(shownVoxels(a)),
      differing_(std::make_shared<MaskTree>()) {
  all_->topologyUnion(*shownVoxels(b));
  differing_->topologyUnion(difference_.onlyA->tree());
  differing_->topologyUnion(difference_.onlyB->tree());
  if (difference_.values) {
    differing_->topologyUnion(difference_.values->tree());
    largest_ = largestFinite(difference_.values->tree());
  }
  const auto shown = std::make_shared<MaskTree>(*differing_);
  shown->topologyIntersection(*all_);
  isPartial_ = !shown->empty() && shown->activeVoxelCount() < differing_->activeVoxelCount();
  if (shown->activeVoxelCount() > 0)
    differing_ = shown;
  else
    all_->topologyUnion(*differing_);
}

const openvdb::FloatTree* DifferenceLook::values() const {
  return difference_.values ? &difference_.values->tree() : nullptr;
}

VoxelChange DifferenceLook::changeAt(const Coord& voxel) const {
  if (difference_.onlyA->tree().isValueOn(voxel)) return VoxelChange::kOnlyA;
  if (difference_.onlyB->tree().isValueOn(voxel)) return VoxelChange::kOnlyB;
  if (difference_.values && difference_.values->tree().isValueOn(voxel)) return VoxelChange::kValue;
  return VoxelChange::kUnchanged;
}

double DifferenceLook::valuePart(const Coord& voxel) const {
  const double value = difference_.values->tree().getValue(voxel);
  return std::isfinite(value) && largest_ > 0 ? value / largest_ : 1;
}

bool DifferenceLook::looksLike(const DifferenceLook& other) const {
  const auto same = [](const openvdb::MaskGrid::Ptr& a, const openvdb::MaskGrid::Ptr& b) {
    return a->tree().hasSameTopology(b->tree());
  };
  const auto hasValues = [](const DifferenceLook& look) {
    return look.values() != nullptr && !look.values()->empty();
  };
  return !hasValues(*this) && !hasValues(other) &&
         same(difference_.onlyA, other.difference_.onlyA) &&
         same(difference_.onlyB, other.difference_.onlyB) &&
         differing_->hasSameTopology(*other.differing_);
}

std::optional<openvdb::Vec3f> DifferenceLook::colorAt(const Coord& voxel) const {
  switch (changeAt(voxel)) {
    case VoxelChange::kOnlyA:
      return linearColor(kOnlyAColor);
    case VoxelChange::kOnlyB:
      return linearColor(kOnlyBColor);
    case VoxelChange::kValue:
      return linearColor(valueColor(valuePart(voxel)));
    default:
      return std::nullopt;
  }
}

VisibleGrids DifferenceLook::visible(const MaskTree::Ptr& voxels, const CoordBBox& box) const {
  VisibleGrids visible;
  visible.toWorld = difference_.onlyA->transformPtr();
  visible.voxels = box.empty() ? voxels : cut(*voxels, box);
  visible.boxes = boxesOf(*visible.voxels);
  visible.colorAt = [this](const Coord& voxel) { return colorAt(voxel); };
  return visible;
}

}  // namespace vox
