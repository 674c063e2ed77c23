// Rays through OpenVDB trees. Source: Amanatides & Woo 1987, Museth 2014 (hierarchical DDA).

#include "libvox/render/ray_cast.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/math/DDA.h>
#include <openvdb/tools/RayIntersector.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

/// Boxes of the voxels below each child of a root. Rays are clipped to them first: the box of the
/// root may be two thousand million voxels long and almost empty.
template <class TreeT>
struct RootBoxes {
  using Child = typename TreeT::RootNodeType::ChildNodeType;
  struct Entry {
    CoordBBox box;
    const Child* child;  // null for an active tile
  };
  std::vector<Entry> entries;

  explicit RootBoxes(const TreeT& tree) {
    for (auto child = tree.root().cbeginChildOn(); child; ++child) {
      CoordBBox box;
      child->evalActiveBoundingBox(box, /*visitVoxels=*/true);
      if (!box.empty()) entries.push_back({box, &*child});
    }
    for (auto tile = tree.root().cbeginValueOn(); tile; ++tile)
      entries.push_back({CoordBBox::createCube(tile.getCoord(), Child::DIM), nullptr});
  }
};

openvdb::BBoxd cubesOf(const CoordBBox& box) {
  return {box.min().asVec3d(), box.max().offsetBy(1).asVec3d()};
}

template <class NodeT>
bool holds(const NodeT& node, const Coord& voxel) {
  constexpr auto kOutside = ~(static_cast<openvdb::Int32>(NodeT::DIM) - 1);
  const Coord& origin = node.origin();
  return (voxel.x() & kOutside) == origin.x() && (voxel.y() & kOutside) == origin.y() &&
         (voxel.z() & kOutside) == origin.z();
}

struct CubeHit {
  double time;
  Coord voxel;
};

using Leaf = openvdb::MaskTree::LeafNodeType;

/// The first active voxel of a leaf between the times of a ray.
std::optional<CubeHit> firstCube(const Leaf& leaf, const IndexRay& ray) {
  openvdb::math::DDA<IndexRay> dda(ray);
  do {
    // Rounding may put a ray that runs along a side just outside.
    if (holds(leaf, dda.voxel()) && leaf.isValueOn(dda.voxel()))
      return CubeHit{dda.time(), dda.voxel()};
  } while (dda.step());
  return std::nullopt;
}

template <class NodeT>
std::optional<CubeHit> firstCube(const NodeT& node, const IndexRay& ray) {
  using Child = typename NodeT::ChildNodeType;
  openvdb::math::DDA<IndexRay, Child::TOTAL> dda(ray);
  do {
    if (!holds(node, dda.voxel())) continue;
    if (const Child* child = node.template probeConstNode<Child>(dda.voxel())) {
      IndexRay within = ray;
      within.setTimes(dda.time(), std::max(dda.time(), dda.next()));
      if (const auto hit = firstCube(*child, within)) return hit;
    } else if (node.isValueOn(dda.voxel())) {
      const auto inside = ray(dda.time());
      Coord voxel = Coord::floor(inside);
      voxel.maxComponent(dda.voxel());
      voxel.minComponent(dda.voxel().offsetBy(static_cast<openvdb::Int32>(Child::DIM) - 1));
      return CubeHit{dda.time(), voxel};
    }
  } while (dda.step());
  return std::nullopt;
}

/// Outward normal of the side through which a ray enters the unit cube at a voxel.
Vec3d sideEntered(const IndexRay& ray, const Coord& voxel) {
  int entered = 0;
  double latest = -std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double direction = ray.dir()[axis];
    if (direction == 0) continue;
    const double side = direction > 0 ? voxel[axis] : voxel[axis] + 1.0;
    const double time = (side - ray.eye()[axis]) / direction;
    if (time <= latest) continue;
    latest = time;
    entered = axis;
  }
  Vec3d normal = Vec3d::Zero();
  normal[entered] = ray.dir()[entered] > 0 ? -1 : 1;
  return normal;
}

class VoxelCaster : public RayCaster {
 public:
  explicit VoxelCaster(const openvdb::MaskTree& voxels)
      : boxes_(std::make_shared<const RootBoxes<openvdb::MaskTree>>(voxels)) {}

  std::optional<RayHit> firstHit(const IndexRay& centred) override {
    // Here a voxel is the cube from its index to the next.
    IndexRay ray(centred.eye() + openvdb::Vec3d(0.5), centred.dir(), centred.t0(), centred.t1());
    std::optional<CubeHit> first;
    for (const auto& [box, child] : boxes_->entries) {
      IndexRay within = ray;
      if (!within.clip(cubesOf(box))) continue;
      const auto hit = child != nullptr
                           ? firstCube(*child, within)
                           : CubeHit{within.t0(), nearestIn(box, Coord::floor(within.start()))};
      if (!hit) continue;
      first = hit;
      ray.setTimes(ray.t0(), std::max(ray.t0(), hit->time));
    }
    if (!first) return std::nullopt;
    return RayHit{first->time, first->voxel, sideEntered(ray, first->voxel)};
  }

  std::unique_ptr<RayCaster> copy() const override { return std::make_unique<VoxelCaster>(*this); }

 private:
  static Coord nearestIn(const CoordBBox& box, Coord voxel) {
    voxel.maxComponent(box.min());
    voxel.minComponent(box.max());
    return voxel;
  }

  std::shared_ptr<const RootBoxes<openvdb::MaskTree>> boxes_;
};

using Intersector = openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid>;

Intersector intersectorOf(const openvdb::FloatGrid& levelSet) {
  try {
    return Intersector(levelSet);
  } catch (const openvdb::Exception& wrong) {
    throw InputError("the level set cannot be shown: " + std::string(wrong.what()));
  }
}

class LevelSetCaster : public RayCaster {
 public:
  explicit LevelSetCaster(const openvdb::FloatGrid& levelSet)
      : levelSet_(&levelSet),
        intersector_(intersectorOf(levelSet)),
        stencil_(levelSet),
        boxes_(std::make_shared<const RootBoxes<openvdb::FloatTree>>(levelSet.tree())) {}
  LevelSetCaster(const LevelSetCaster& other)
      : levelSet_(other.levelSet_),
        intersector_(other.intersector_),
        stencil_(*levelSet_),
        boxes_(other.boxes_) {}
  LevelSetCaster& operator=(const LevelSetCaster&) = delete;

  std::optional<RayHit> firstHit(const IndexRay& all) override {
    std::optional<RayHit> first;
    IndexRay ray = all;
    for (const auto& entry : boxes_->entries) {
      IndexRay within = ray;
      double time = 0;
      openvdb::Vec3d point;
      if (!within.clip(cubesOf(entry.box)) || !intersector_.intersectsIS(within, point, time))
        continue;
      // The library gives the time where the ray enters the box.
      time = (point - ray.eye()).dot(ray.dir()) / ray.dir().lengthSqr();
      first = RayHit{time, Coord::round(point), normalAt(point, ray)};
      ray.setTimes(ray.t0(), std::max(ray.t0(), time));
    }
    return first;
  }

  std::unique_ptr<RayCaster> copy() const override {
    return std::make_unique<LevelSetCaster>(*this);
  }

 private:
  Vec3d normalAt(const openvdb::Vec3d& point, const IndexRay& ray) {
    stencil_.moveTo(point);
    const auto gradient = stencil_.gradient(point);
    const Vec3d normal(gradient[0], gradient[1], gradient[2]);
    const double length = normal.norm();
    if (length > 0 && std::isfinite(length)) return normal / length;
    return -Vec3d(ray.dir()[0], ray.dir()[1], ray.dir()[2]).normalized();
  }

  const openvdb::FloatGrid* levelSet_;
  Intersector intersector_;
  openvdb::math::BoxStencil<openvdb::FloatGrid> stencil_;
  std::shared_ptr<const RootBoxes<openvdb::FloatTree>> boxes_;
};

/// Sets components to 0 that are rounding errors.
Vec3d withoutRounding(Vec3d direction) {
  constexpr double kNothing = 1e-12;
  for (double& component : direction)
    if (std::abs(component) < kNothing) component = 0;
  return direction;
}

openvdb::Vec3d asOpenVdb(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

IndexRay indexRay(const Vec3d& origin, const Vec3d& direction, double start, double end) {
  return {asOpenVdb(origin), asOpenVdb(withoutRounding(direction)), start, end};
}

IndexRay indexRay(const Sight& sight, const openvdb::math::MapBase& toWorld) {
  const openvdb::Vec3d direction = toWorld.applyInverseJacobian(asOpenVdb(sight.direction));
  const openvdb::Vec3d eye = toWorld.applyInverseMap(asOpenVdb(sight.origin));
  const Vec3d unit = Vec3d(direction[0], direction[1], direction[2]).normalized();
  return indexRay(Vec3d(eye[0], eye[1], eye[2]), unit);
}

std::unique_ptr<RayCaster> voxelCaster(const openvdb::MaskTree& voxels) {
  return std::make_unique<VoxelCaster>(voxels);
}

std::unique_ptr<RayCaster> levelSetCaster(const openvdb::FloatGrid& levelSet) {
  return std::make_unique<LevelSetCaster>(levelSet);
}

}  // namespace vox
