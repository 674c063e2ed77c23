// Patches to tiles of normals.

#include "libvox/voxelize/normal_sampler.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/voxelize/normal_tile.h"
#include "libvox/voxelize/voxel_box.h"

#include <algorithm>

namespace vox {

Patch quarterTurn(const Patch& patch) {
  Patch turned;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v) turned.points[u][v] = patch.points[v][2 - u];
  return turned;
}

std::array<Patch, 2> halvesAlongU(const Patch& patch) {
  std::array<Patch, 2> halves;
  for (std::size_t v = 0; v < 3; ++v) {
    const Vec3d& a = patch.points[0][v];
    const Vec3d& b = patch.points[1][v];
    const Vec3d& c = patch.points[2][v];
    const std::array<Vec3d, 4> fine = {chaikin(a, b), chaikin(b, a), chaikin(b, c), chaikin(c, b)};
    for (std::size_t u = 0; u < 3; ++u) {
      halves[0].points[u][v] = fine[u];
      halves[1].points[u][v] = fine[u + 1];
    }
  }
  return halves;
}

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
