// The descendants of a vertex as an array.

#include "libvox/subdivide/vertex_array.h"

#include "libvox/mesh/patch_parts.h"

#include <algorithm>

namespace vox {

/// Collects the blocks of an irregular vertex.
class VertexArray::Blocks {
 public:
  /// @param depth  of the vertex
  Blocks(int depth, std::vector<Block>& blocks) : depth_(depth), blocks_(blocks) {}

  void regular(const Patch& patch, int level, const CornerSquare& square) {
    // Patches in the V-face are turned, because u and v fall towards the V-face.
    const bool turned = square.sideU < 0;
    const CornerSquare within = turned ? square.turned() : square;
    const auto size = static_cast<double>(std::int64_t{1} << depth_);
    const auto log2 = static_cast<std::uint8_t>(depth_ - (level - 1));
    blocks_.push_back({turned ? halfTurn(patch) : patch,
                       static_cast<std::int64_t>(within.u * size),
                       static_cast<std::int64_t>(within.v * size),
                       {log2, log2}});
  }
  bool ends(const FaceCorner& corner, int level, const CornerSquare& square) {
    return endsAt(corner.around.points[1][1], level, square);
  }
  bool ends(const BoundaryCorner& corner, int level, const CornerSquare& square) {
    return endsAt(corner.u, level, square);
  }
  /// Adds an irregular vertex as a block if it is deep enough.
  bool endsAt(const Vec3d& point, int level, const CornerSquare& square) {
    if (level - 1 < depth_) return false;
    Patch patch;
    for (auto& row : patch.points) row.fill(point);
    regular(patch, level, square);
    return true;
  }

 private:
  int depth_;
  std::vector<Block>& blocks_;
};

void VertexArray::set(const LevelOneVertex& vertex, VertexDepth depth) {
  if (vertex.regular) return set(vertex.around, depth);
  depth_ = depth;
  blocks_.clear();
  Blocks blocks(depth.u, blocks_);
  if (!blocks.endsAt(vertex.around.points[1][1], 1, {})) Descent(blocks).below(vertex, {});
}

void VertexArray::alongV(std::int64_t i, std::int64_t first, std::span<Vec3d> points) const {
  const auto end = first + static_cast<std::int64_t>(points.size());
  for (const Block& block : blocks_) {
    if (i < block.u || i >= block.endU()) continue;
    const std::int64_t from = std::max(first, block.v);
    const std::int64_t to = std::min(end, block.endV());
    if (from >= to) continue;
    const CurvePoints row = rowOf(block.patch, {i - block.u, block.endU() - block.u});
    for (std::int64_t j = from; j < to; ++j)
      points[static_cast<std::size_t>(j - first)] =
          PatchWeights(j - block.v, block.endV() - block.v)(row[0], row[1], row[2]);
  }
}

void VertexArray::alongU(std::int64_t j, std::int64_t first, std::span<Vec3d> points) const {
  const auto end = first + static_cast<std::int64_t>(points.size());
  for (const Block& block : blocks_) {
    if (j < block.v || j >= block.endV()) continue;
    const PatchWeights v(j - block.v, block.endV() - block.v);
    const std::int64_t to = std::min(end, block.endU());
    for (std::int64_t i = std::max(first, block.u); i < to; ++i) {
      const CurvePoints row = rowOf(block.patch, {i - block.u, block.endU() - block.u});
      points[static_cast<std::size_t>(i - first)] = v(row[0], row[1], row[2]);
    }
  }
}

}  // namespace vox
