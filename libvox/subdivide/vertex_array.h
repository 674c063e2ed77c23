#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level_one_vertex.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// How deep a level-1 vertex is subdivided: it becomes 2^u x 2^v vertices.
struct VertexDepth {
  std::uint8_t u = 0;
  std::uint8_t v = 0;
  bool operator==(const VertexDepth&) const = default;
};

/// Largest depth: a vertex has 2^60 descendants there, more than fit into any memory.
inline constexpr int kMostDepth = 30;

/// The descendants of a level-1 vertex. For all valences they are an array of 2^u x 2^v vertices
/// with quads between them. F lies at the corner of the array where u and v are largest, the V-face
/// at the opposite corner, R where u is largest and v smallest, L opposite R (vertex_split.h).
///
/// The array consists of blocks. A regular vertex is one block in closed form. An irregular vertex
/// is 2 x 2 blocks, for its children in R, L, F and the V-face. If F or the V-face is not a quad,
/// the child in it is split in the same way, level by level. All functions evaluate a point in the
/// same way, so that it always has the same bits. Several threads may read an array.
class VertexArray {
 public:
  /// A block: its patch, first row and column, and depth. All control points of a block of one
  /// irregular vertex are this vertex.
  struct Block {
    Patch patch;
    std::int64_t u, v;
    VertexDepth depth;
    std::int64_t sizeU() const { return std::int64_t{1} << depth.u; }
    std::int64_t sizeV() const { return std::int64_t{1} << depth.v; }
    std::int64_t endU() const { return u + sizeU(); }
    std::int64_t endV() const { return v + sizeV(); }
  };

  /// Sets the array of a level-1 vertex.
  /// @param depth  u = v for an irregular vertex
  void set(const LevelOneVertex& vertex, VertexDepth depth);
  /// Sets the array of a regular vertex of any level.
  void set(const Patch& patch, VertexDepth depth) {
    depth_ = depth;
    blocks_.assign(1, {patch, 0, 0, depth});
  }

  /// The blocks; they cover the array once.
  const std::vector<Block>& blocks() const { return blocks_; }

  VertexDepth depth() const { return depth_; }
  std::int64_t sizeU() const { return std::int64_t{1} << depth_.u; }
  std::int64_t sizeV() const { return std::int64_t{1} << depth_.v; }

  /// Sets `points` to the vertices (i, j) with j = first, first + 1, ...
  void alongV(std::int64_t i, std::int64_t first, std::span<Vec3d> points) const;
  /// Sets `points` to the vertices (i, j) with i = first, first + 1, ...
  void alongU(std::int64_t j, std::int64_t first, std::span<Vec3d> points) const;
  /// Vertex (i, j).
  Vec3d at(std::int64_t i, std::int64_t j) const {
    Vec3d point;
    alongV(i, j, {&point, 1});
    return point;
  }

  Vec3d cornerF() const { return at(sizeU() - 1, sizeV() - 1); }
  Vec3d cornerVFace() const { return at(0, 0); }
  Vec3d cornerR() const { return at(sizeU() - 1, 0); }
  Vec3d cornerL() const { return at(0, sizeV() - 1); }

 private:
  class Blocks;

  VertexDepth depth_;
  std::vector<Block> blocks_;
};

}  // namespace vox
