// Splits patches into tiles for the vector unit.

#include "libvox/voxelize/normal_sampler.h"

#include "libvox/mesh/patch_parts.h"
#include "libvox/voxelize/normal_tile.h"
#include "libvox/voxelize/voxel_box.h"

#include <algorithm>

namespace vox {

void NormalSampler::patch(const Patch& patch, int rows, int columns) {
  const int longer = std::max(rows, columns);
  if (longer < kLeastNormalLevels) return each(patch, rows, columns);
  const VoxelBox box(patch, kNormalTileError);
  if (longer <= kMostNormalLevels && MarkBrick::fits(box.low, box.high)) {
    if (columns < kLeastNormalLevels)
      addNormalTile(quarterTurn(patch), columns, rows, brick_.marks(), brick_.sums());
    else
      addNormalTile(patch, rows, columns, brick_.marks(), brick_.sums());
    brick_.collect(box.low, box.high);
    return;
  }
  const bool turn = rows < columns;
  for (const Patch& half : halvesAlongU(turn ? quarterTurn(patch) : patch))
    this->patch(half, longer - 1, std::min(rows, columns));
}

void NormalSampler::point(const Vec3d& position, const Vec3d& normal) {
  if (!normal.isZero(0)) brick_.add(voxelOf(position), normal);
}

void NormalSampler::each(const Patch& patch, int rows, int columns) {
  const std::int64_t m = std::int64_t{1} << rows;
  const std::int64_t n = std::int64_t{1} << columns;
  for (std::int64_t i = 0; i < m; ++i) {
    const CurvePoints row = rowOf(patch, {i, m});
    const LimitNormals normals(patch, SplinePlace::ofVertex(i, m));
    for (std::int64_t j = 0; j < n; ++j)
      point(PatchWeights(j, n)(row[0], row[1], row[2]), normals.at(SplinePlace::ofVertex(j, n)));
  }
}

}  // namespace vox
