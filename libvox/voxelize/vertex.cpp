// Vertex conversion (Cohen, Kaufman & Wang 1994, section 5).

#include "libvox/voxelize/vertex.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace vox {
namespace {

constexpr std::size_t kPointsPerTask = 16384;

}  // namespace

void markVertices(std::span<const Vec3d> positionsIndex, openvdb::MaskGrid& mask) {
  tbb::enumerable_thread_specific<openvdb::MaskTree> trees;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positionsIndex.size(), kPointsPerTask),
                    [&](const auto& range) {
                      openvdb::tree::ValueAccessor<openvdb::MaskTree> voxels(trees.local());
                      for (std::size_t i = range.begin(); i != range.end(); ++i)
                        voxels.setValueOn(voxelOf(positionsIndex[i]));
                    });
  trees.combine_each([&](openvdb::MaskTree& tree) { mask.tree().merge(tree); });
}

}  // namespace vox
