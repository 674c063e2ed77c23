// The ball that does not fit through an opening: a dilated surface and what it encloses.

#include "libvox/volume/close.h"

#include "libvox/grid/openvdb.h"
#include "libvox/volume/fill.h"

#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <array>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::MaskTree;
using CoordList = std::vector<Coord>;
using MaskReader = openvdb::tree::ValueAccessor<const MaskTree>;
using MaskWriter = openvdb::tree::ValueAccessor<MaskTree>;

constexpr std::array<std::array<int, 3>, 6> kSteps = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

Coord neighbour(const Coord& voxel, const std::array<int, 3>& step) {
  return voxel.offsetBy(step[0], step[1], step[2]);
}

MaskTree copyOf(const MaskTree& tree) {
  MaskTree copy;  // its copy constructor is not in OpenVDB's library
  copy.topologyUnion(tree);
  return copy;
}

/// Each voxel becomes a cube of 2 x 2 x 2.
MaskTree doubled(const MaskTree& tree) {
  MaskTree result;
  MaskWriter writer(result);
  for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel)
    for (int i = 0; i < 8; ++i)
      writer.setValueOn(voxel.getCoord().offsetBy(i & 1, i >> 1 & 1, i >> 2));
  return result;
}

void grow(MaskTree& tree, openvdb::tools::NearestNeighbors neighbours) {
  openvdb::tools::dilateActiveValues(tree, 1, neighbours);
}

/// The centres at which a ball of this width touches the surface.
MaskTree touched(const MaskTree& surface, int width) {
  constexpr int kPeriod = 5;  // 3 layers through faces, 2 through corners: an octagonal ball
  MaskTree result = width % 2 == 0 ? doubled(surface) : copyOf(surface);
  for (int layer = 0; layer < (width - 1) / 2; ++layer)
    grow(result,
         layer % kPeriod % 2 == 0 ? openvdb::tools::NN_FACE : openvdb::tools::NN_FACE_EDGE_VERTEX);
  return result;
}

CoordList voxelsOf(const MaskTree& tree) {
  CoordList voxels;
  for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel) voxels.push_back(voxel.getCoord());
  return voxels;
}

/// Takes the inactive voxels around a surface, from inside and outside in turn.
class Meeting {
 public:
  /// @param touched   the voxels to take, if they are not of the surface
  /// @param reached   `touched`, and all that it encloses
  Meeting(const MaskTree& surface, const MaskTree& touched, const MaskTree& reached)
      : surface_(surface), touched_(touched), reached_(reached) {}

  void run(CoordList inside, CoordList outside) {
    while (!inside.empty()) {
      take(inside, inner_);
      take(outside, outer_);
    }
  }

  Closure closure() const {
    Closure closure;
    closure.voxels = std::make_shared<MaskTree>();
    MaskWriter closing(*closure.voxels);
    for (auto voxel = inner_.cbeginValueOn(); voxel; ++voxel)
      for (const auto& step : kSteps) {
        const Coord next = neighbour(voxel.getCoord(), step);
        if (!outer_.isValueOn(next) && reached_.isValueOn(next)) continue;
        closing.setValueOn(voxel.getCoord());
        closure.sides.emplace_back(voxel.getCoord(), next);
      }
    closure.voxelCount = closure.voxels->activeVoxelCount();
    return closure;
  }

 private:
  /// The next layer around some voxels.
  void take(CoordList& front, MaskTree& taken) {
    MaskReader surface(surface_), touched(touched_), inner(inner_), outer(outer_);
    MaskWriter writer(taken);
    CoordList next;
    for (const Coord& voxel : front)
      for (const auto& step : kSteps) {
        const Coord at = neighbour(voxel, step);
        if (!touched.isValueOn(at) || surface.isValueOn(at) || inner.isValueOn(at) ||
            outer.isValueOn(at))
          continue;
        writer.setValueOn(at);
        next.push_back(at);
      }
    front = std::move(next);
  }

  const MaskTree& surface_;
  const MaskTree& touched_;
  const MaskTree& reached_;
  MaskTree inner_, outer_;
};

std::uint64_t countConnected(const MaskTree& tree) {
  MaskTree seen;
  MaskWriter writer(seen);
  std::uint64_t sets = 0;
  CoordList work;
  for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel) {
    if (writer.isValueOn(voxel.getCoord())) continue;
    ++sets;
    work.assign(1, voxel.getCoord());
    writer.setValueOn(voxel.getCoord());
    while (!work.empty()) {
      const Coord at = work.back();
      work.pop_back();
      for (int i = 0; i < 27; ++i) {
        const Coord next = at.offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
        if (!tree.isValueOn(next) || writer.isValueOn(next)) continue;
        writer.setValueOn(next);
        work.push_back(next);
      }
    }
  }
  return sets;
}

}  // namespace

Closure closureOf(const openvdb::MaskTree& surface, int width) {
  if (width < 2 || surface.empty()) return {};
  const MaskTree touching = touched(surface, width);
  const MaskTree::Ptr reached = filled(touching, {});
  MaskTree room = copyOf(*reached);  // where the ball has room, but cannot get to
  room.topologyDifference(touching);
  room.topologyDifference(*filled(surface, {}));
  if (room.empty() || room.activeVoxelCount() == 0) return {};

  MaskTree around = copyOf(touching);
  grow(around, openvdb::tools::NN_FACE);
  MaskTree inside = copyOf(around);
  inside.topologyIntersection(room);
  around.topologyDifference(*reached);
  Meeting meeting(surface, touching, *reached);
  meeting.run(voxelsOf(inside), voxelsOf(around));
  Closure closure = meeting.closure();
  if (closure.voxelCount == 0) return {};
  closure.openings = countConnected(*closure.voxels);
  return closure;
}

std::uint64_t bytesOfClosing(const openvdb::MaskTree& surface, int width) {
  // The layers around the surface, and as much again for what is taken of them. A layer of leaves
  // is added on both sides for each 8 voxels; the box bounds their number.
  constexpr std::uint64_t kBytesOfLeaf = 4 * sizeof(MaskTree::LeafNodeType);
  const std::uint64_t leaves = surface.leafCount() * (1 + static_cast<std::uint64_t>(width) / 4);
  openvdb::CoordBBox box;
  surface.evalLeafBoundingBox(box);
  box.expand(width);
  std::uint64_t most = 1;
  for (int axis = 0; axis < 3; ++axis)
    most *= static_cast<std::uint64_t>(box.dim()[axis]) / MaskTree::LeafNodeType::DIM + 2;
  return bytesOfFilling(surface) + kBytesOfLeaf * std::min(leaves, most);
}

}  // namespace vox
