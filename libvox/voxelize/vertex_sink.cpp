// Vertex conversion (Cohen, Kaufman & Wang 1994, section 5).

#include "libvox/voxelize/vertex_sink.h"

#include "libvox/grid/voxel.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/voxelize/row.h"
#include "libvox/voxelize/tile.h"
#include "libvox/voxelize/voxel_box.h"

#include <algorithm>

namespace vox {
namespace {

constexpr std::size_t kMostSmallVertices = std::size_t{1} << (2 * (kLeastTileLevels - 1));

/// Weights of the 2^k vertices along an axis of a patch that is too small for a tile.
std::span<const PatchWeights> smallWeights(int k) {
  static_assert(kLeastTileLevels == 3);
  static const std::array<PatchWeights, 7> kWeights = {
      {{0, 1}, {0, 2}, {1, 2}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
  const std::size_t n = std::size_t{1} << k;
  return std::span(kWeights).subspan(n - 1, n);
}

}  // namespace

void VertexSink::mark(const Vec3d& position) {
  cache_.add(voxelOf(position));
}

void VertexSink::points(std::span<const Vec3d> points, int level) {
  vertices_[static_cast<std::size_t>(level)] += points.size();
  cache_.add(points);
}

void VertexSink::curve(const CurvePoints& points, int k, int level) {
  const std::int64_t n = std::int64_t{1} << k;
  vertices_[static_cast<std::size_t>(level)] += static_cast<std::uint64_t>(n);
  LeafCache::Positions positions;
  constexpr auto kMost = static_cast<std::int64_t>(LeafCache::kPositionsAtOnce);
  for (std::int64_t j = 0; j < n; j += kMost) {
    const auto count = static_cast<std::size_t>(std::min(kMost, n - j));
    setRow(points, n, j, count, positions);
    cache_.add(positions, count);
  }
}

void VertexSink::patch(const Patch& patch, int k, int level) {
  std::uint64_t& vertices = vertices_[static_cast<std::size_t>(level)];
  if (patch.quadrants != kAllQuadrants) {
    vertices += markFewQuadrants(patch, k);
    return;
  }
  vertices += std::uint64_t{1} << (2 * k);
  markWhole(patch, k);
}

/// Marks the descendants of a vertex with missing faces. They lie only towards the faces that
/// exist: a vertex between two faces becomes a row, a vertex of one face a single vertex, and a
/// vertex of three faces two rows with a common end.
/// @return number of descendants
std::uint64_t VertexSink::markFewQuadrants(const Patch& patch, int k) {
  const std::int64_t n = std::int64_t{1} << k;
  const auto has = [&](unsigned quadrant) { return (patch.quadrants >> quadrant & 1U) != 0; };
  const bool lowU = has(0) && has(1);
  const bool highU = has(2) && has(3);
  const bool lowV = has(0) && has(2);
  const bool highV = has(1) && has(3);
  std::uint64_t count = 0;
  const auto markAt = [&](std::int64_t i, std::int64_t j) {
    const PatchWeights u(i, n);
    const PatchWeights v(j, n);
    const auto& p = patch.points;
    mark(u(v(p[0][0], p[0][1], p[0][2]), v(p[1][0], p[1][1], p[1][2]),
           v(p[2][0], p[2][1], p[2][2])));
    ++count;
  };
  // The row (u) and the column (v) on which the descendants lie: at the end of the axis that has
  // the faces.
  const std::int64_t u = highU || (!lowU && (has(2) || has(3))) ? n - 1 : 0;
  const std::int64_t v = highV || (!lowV && (has(1) || has(3))) ? n - 1 : 0;
  const bool rowAlongV = lowU || highU;
  const bool rowAlongU = lowV || highV;
  if (rowAlongV)
    for (std::int64_t j = 0; j < n; ++j) markAt(u, j);
  if (rowAlongU)
    for (std::int64_t i = 0; i < n; ++i)
      if (!rowAlongV || i != u) markAt(i, v);
  if (!rowAlongU && !rowAlongV) markAt(u, v);
  return count;
}

void VertexSink::markWhole(const Patch& patch, int k) {
  if (k < kLeastTileLevels) return markSmall(patch, k);
  if (k <= kMostTileLevels) {
    const VoxelBox box(patch, kTileError);
    if (MarkBrick::fits(box.low, box.high)) {
      markTile(tileControls(patch), k, cache_.marks());
      cache_.collect(box.low, box.high);
      return;
    }
  }
  for (const auto& row : childrenOf(patch))
    for (const Patch& child : row) markWhole(child, k - 1);
}

void VertexSink::markSmall(const Patch& patch, int k) {
  const auto weights = smallWeights(k);
  std::array<Vec3d, kMostSmallVertices> vertices;
  std::size_t count = 0;
  for (const PatchWeights& u : weights) {
    const CurvePoints row = rowOf(patch, u);
    for (const PatchWeights& v : weights) vertices[count++] = v(row[0], row[1], row[2]);
  }
  cache_.add(std::span(vertices).first(count));
}

}  // namespace vox
