#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/extraordinary_levels.h"
#include "libvox/subdivide/vertex_split.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vox {

/// How deep a level-1 vertex is subdivided: it becomes 2^u x 2^v vertices.
struct VertexDepth {
  std::uint8_t u = 0;
  std::uint8_t v = 0;
  bool operator==(const VertexDepth&) const = default;
};

/// More than any surface has room for: 2^60 vertices.
inline constexpr int kMostDepth = 30;

/// A level-1 vertex and what lies around it, as far as it is known: points that are not known are
/// 0, and rows of descendants that do not depend on them have the same bits all the same.
struct LevelOneVertex {
  LevelOneVertex();

  Vec3d at = Vec3d::Zero();
  bool regular = false;
  Patch patch;  ///< of a regular vertex

  // Of an irregular one, level 2:
  VertexSplit split;
  bool quadF = true;      ///< split.fOpposite is known
  bool quadVFace = true;  ///< split.vFaceOpposite is known
  // Where they are no quads:
  ExtraordinaryLevels* levelsOfF = nullptr;
  std::size_t placeInF = 0;
  ExtraordinaryLevels* levelsOfVFace =
      nullptr;  ///< its corners run round the other way: R is behind L
  std::size_t placeInVFace = 0;
  std::optional<BoundaryCorner> corner;  ///< in place of the V-face, where the vertex has one face

  /// Whether its descendants are an array with faces between them: else they are rows at most.
  bool whole() const {
    return regular ? patch.quadrants == kAllQuadrants : split.hasR && split.hasL && split.hasVFace;
  }
};

/// The descendants of a level-1 vertex: whatever the valences, an array of 2^u x 2^v vertices with
/// quads between them. F lies at its end where u and v are largest, the V-face at the other, R
/// where u is largest and v smallest, L opposite R (vertex_split.h).
///
/// A regular vertex is one block in closed form. An irregular one is 2 x 2 blocks for its children
/// in R, L, F and the V-face, of which those in F and the V-face go on in the same way, level by
/// level. All points are evaluated in one way, so that they have the same bits for whoever asks.
class VertexArray {
 public:
  /// Part of the array: first row and column, logarithms of the sizes. Where the vertex of a block
  /// of one point is not regular, the patch says no more than the point and, if normals are wanted,
  /// the tangent plane: the normal has the same closed form in every block.
  struct Block {
    Patch patch;
    std::int64_t u, v;
    VertexDepth depth;
    std::int64_t sizeU() const { return std::int64_t{1} << depth.u; }
    std::int64_t sizeV() const { return std::int64_t{1} << depth.v; }
    std::int64_t endU() const { return u + sizeU(); }
    std::int64_t endV() const { return v + sizeV(); }
  };

  /// @param depth    u = v for an irregular vertex
  /// @param normals  whether normals will be asked for; then all around the vertex must be known
  void set(const LevelOneVertex& vertex, VertexDepth depth, bool normals = false);
  /// The array of a regular vertex of any level.
  void set(const Patch& patch, VertexDepth depth) {
    depth_ = depth;
    blocks_.assign(1, {patch, 0, 0, depth});
  }

  /// They cover the array once.
  const std::vector<Block>& blocks() const { return blocks_; }

  VertexDepth depth() const { return depth_; }
  std::int64_t sizeU() const { return std::int64_t{1} << depth_.u; }
  std::int64_t sizeV() const { return std::int64_t{1} << depth_.v; }

  /// Vertices (i, j) with j = first, first + 1, ...
  void alongV(std::int64_t i, std::int64_t first, std::span<Vec3d> points) const;
  /// Vertices (i, j) with i = first, first + 1, ...
  void alongU(std::int64_t j, std::int64_t first, std::span<Vec3d> points) const;
  Vec3d at(std::int64_t i, std::int64_t j) const {
    Vec3d point;
    alongV(i, j, {&point, 1});
    return point;
  }

  /// Exact unit normals of the smooth surface at the limit points of these vertices, outward; 0
  /// where there is none. With the same bits for whoever asks.
  void normalsAlongV(std::int64_t i, std::int64_t first, std::span<Vec3d> normals) const;
  void normalsAlongU(std::int64_t j, std::int64_t first, std::span<Vec3d> normals) const;
  Vec3d normalAt(std::int64_t i, std::int64_t j) const {
    Vec3d normal;
    normalsAlongV(i, j, {&normal, 1});
    return normal;
  }
  /// Beside a vertex at the boundary of an extended surface: the normals on the boundary itself,
  /// across R from the vertices (i, 0), i = first, first + 1, ..., and across L from (0, j). Beside
  /// a block of one irregular vertex, that vertex's.
  void normalsAcrossR(std::int64_t first, std::span<Vec3d> normals) const;
  void normalsAcrossL(std::int64_t first, std::span<Vec3d> normals) const;

  Vec3d cornerF() const { return at(sizeU() - 1, sizeV() - 1); }
  Vec3d cornerVFace() const { return at(0, 0); }
  Vec3d cornerR() const { return at(sizeU() - 1, 0); }
  Vec3d cornerL() const { return at(0, sizeV() - 1); }

 private:
  void add(const Patch& patch, std::int64_t u, std::int64_t v, int k);
  template <class Split>
  void addPoint(const Vec3d& point, Split&& split, std::int64_t u, std::int64_t v);
  void addInF(ExtraordinaryLevels& levels, std::size_t place, std::int64_t u, std::int64_t v,
              int k);
  void addInVFace(ExtraordinaryLevels& levels, std::size_t place, int k);
  void addInCorner(BoundaryCorner corner, int k);

  VertexDepth depth_;
  bool normals_ = false;
  std::vector<Block> blocks_;
};

}  // namespace vox
