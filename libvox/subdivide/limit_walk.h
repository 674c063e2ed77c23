#pragma once

#include "libvox/mesh/limit_piece.h"
#include "libvox/subdivide/local_vertices.h"

#include <cstdint>
#include <span>

namespace vox {

/// The limit surface of submeshes of a base mesh as biquadratic pieces that cover it without gaps.
///
/// A regular vertex is one piece. Around an extraordinary face the pieces are rings of vertices,
/// level by level, until the rest is closed well enough by pieces that treat the face as a quad:
/// the fourth corner of the quad is placed so that the centroids agree. Such a piece has the exact
/// limit point of the face, meets its neighbours without a gap and the rings without a kink. The
/// rings end when the next level would move by less than the tolerance along the normal.
///
/// At a free boundary the surface ends in curves between the faces that exist. Each is a piece of
/// hardly any width (kAllSides).
///
/// A corner owns its pieces, so if submeshes cover the mesh once, the pieces cover the surface
/// once. The pieces of a corner come in an order that does not depend on the submeshes; all have
/// the same bits in every submesh. One object per thread. Source: paper section 4; DESIGN
/// section 18.
class LimitWalk {
 public:
  /// @param base       level 0, in index space: an oriented manifold with one fan of faces at each
  ///   vertex
  explicit LimitWalk(const SubdivisionLevel& base, const PieceTolerance& tolerance)
      : vertices_(base), tolerance_(tolerance) {}

  const SubdivisionLevel& base() const { return vertices_.images().base(); }

  /// Gives the sink the pieces that the corners of some faces own.
  /// @param faces  of the base
  /// @throws LimitError  coordinates are out of range
  void emit(std::span<const Index> faces, LimitSink& sink);

 private:
  void emitVertex(const SubmeshCorner& at, LimitSink& sink);
  std::uint8_t boundarySidesAt(const SubmeshCorner& at) const;

  LocalVertices vertices_;
  PieceTolerance tolerance_;
};

}  // namespace vox
