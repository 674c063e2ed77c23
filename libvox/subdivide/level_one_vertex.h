#pragma once

#include "libvox/mesh/limit_piece.h"
#include "libvox/mesh/patch.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/boundary_corner.h"
#include "libvox/subdivide/face_levels.h"
#include "libvox/subdivide/vertex_split.h"

#include <cstddef>
#include <optional>

namespace vox {

/// A level-1 vertex and the four faces around it. Points that are not known are 0. Descendants that
/// do not depend on them have the same bits as if they were known.
struct LevelOneVertex {
  /// The vertex as if its faces were quads. Of a face that is not one, the corner opposite the
  /// vertex has no meaning.
  Patch around;
  bool regular = false;  ///< all faces that exist are quads

  // Only for an irregular vertex:
  FaceLevels* face = nullptr;  ///< the levels of F; null if F is not known
  std::size_t place = 0;       ///< of the vertex among the corners of F
  /// The same for the V-face; null if there is none or it is a triangle. Its corners run the other
  /// way round: the next corner lies across L.
  FaceLevels* vFace = nullptr;
  std::size_t placeInVFace = 0;
  /// The points of the triangle in place of the V-face, if the base vertex is on the boundary and
  /// has only one face.
  struct Triangle {
    Vec3d mStart, mEnd;
  };
  std::optional<Triangle> triangle;

  /// Whether all four faces around the vertex exist, so that there are faces between its
  /// descendants.
  bool whole() const { return around.quadrants == kAllQuadrants; }
  /// One step at the vertex.
  VertexSplit split() const;
};

/// A vertex of level >= 2 in a face that is not a quad; the other faces around the vertex are quads
/// or do not exist.
struct FaceCorner {
  FaceLevels& face;
  std::size_t place;  ///< of the vertex among the corners of the face
  Patch around;       ///< as in LevelOneVertex, with the face as F

  /// One step at the vertex, of a given level.
  VertexSplit split(int level) const;
};

/// Checks a level below an extraordinary face. Sizes halve with each level, starting from at most
/// 2^32 voxels, so 64 levels are enough for all coordinates in range.
/// @throws LimitError  the level is above 64
void requireLevelInRange(int level);

/// Visits the descendants of an irregular level-1 vertex: the one walk below a vertex. It gives a
/// sink each regular vertex that makes the surface, and asks at each irregular one whether to go
/// on. Each descendant comes with its level and with its part of the square of the vertex:
///
///   void regular(const Patch& patch, int level, const CornerSquare& square);
///   bool ends(const FaceCorner& corner, int level, const CornerSquare& square);
///   bool ends(const BoundaryCorner& corner, int level, const CornerSquare& square);
///
/// If `ends` is true, the sink has taken the vertex with all its descendants. An irregular vertex
/// has one irregular child in each of its faces that is not a quad; so the walk goes down a chain
/// in F and another one in the V-face. In the V-face, parameters run the other way (turned).
/// Source: paper section 4; DESIGN section 7.
///
/// @throws LimitError  a chain does not end: coordinates are out of range
template <class Sink>
class Descent {
 public:
  explicit Descent(Sink& sink) : sink_(sink) {}

  void below(const LevelOneVertex& vertex, const CornerSquare& square) {
    const VertexSplit split = vertex.split();
    giveSides(split, 2, square);
    const CornerSquare inF = square.quarter(true, true);
    if (vertex.face != nullptr && vertex.face->size() != 4)
      around({*vertex.face, vertex.place, split.childInF()}, inF);
    else
      sink_.regular(split.childInF(), 2, inF);
    if (!split.hasVFace) return;
    const CornerSquare inVFace = square.quarter(false, false);
    if (vertex.triangle) {
      const TriangleImages t(vertex.around.points[1][1], vertex.triangle->mStart,
                             vertex.triangle->mEnd);
      alongBoundary(t.below(split), inVFace);
    } else if (vertex.vFace->size() != 4) {
      around({*vertex.vFace, vertex.placeInVFace, halfTurn(split.childInVFace())},
             inVFace.turned());
    } else {
      sink_.regular(split.childInVFace(), 2, inVFace);
    }
  }

 private:
  /// Gives the sink the children in R and L.
  void giveSides(const VertexSplit& split, int level, const CornerSquare& square) {
    if (split.hasR) sink_.regular(split.childInR(), level, square.quarter(true, false));
    if (split.hasL) sink_.regular(split.childInL(), level, square.quarter(false, true));
  }

  void around(FaceCorner corner, CornerSquare square) {
    for (int level = 2; !sink_.ends(corner, level, square); ++level) {
      requireLevelInRange(level + 1);
      const VertexSplit split = corner.split(level);
      giveSides(split, level + 1, square);
      if (split.hasVFace)
        sink_.regular(split.childInVFace(), level + 1, square.quarter(false, false));
      corner.around = split.childInF();
      square = square.quarter(true, true);
    }
  }

  void alongBoundary(BoundaryCorner corner, CornerSquare square) {
    for (int level = 2; !sink_.ends(corner, level, square); ++level) {
      requireLevelInRange(level + 1);
      const VertexSplit split = corner.split();
      giveSides(split, level + 1, square);
      sink_.regular(split.childInF(), level + 1, square.quarter(true, true));
      corner = corner.below(split);
      square = square.quarter(false, false);
    }
  }

  Sink& sink_;
};

}  // namespace vox
