#pragma once

#include "libvox/mesh/limit_piece.h"
#include "libvox/subdivide/extraordinary.h"
#include "libvox/subdivide/local_images.h"
#include "libvox/subdivide/v_face_level.h"
#include "libvox/subdivide/vertex_split.h"

#include <span>
#include <vector>

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
  /// @param tolerance  voxels
  explicit LimitWalk(const SubdivisionLevel& base, double tolerance)
      : images_(base), tolerance_(tolerance) {}

  const SubdivisionLevel& base() const { return images_.base(); }

  /// Gives the sink the pieces that the corners of some faces own.
  /// @param faces  of the base; the span must stay valid until the next call
  /// @throws LimitError  coordinates are out of range
  void emit(std::span<const Index> faces, LimitSink& sink);

 private:
  struct Corner : SlotCorner {
    Index number;  // in the base mesh
    CornerSquare square() const { return {number}; }
  };

  void emitFace(Index face, Index firstSlot, LimitSink& sink);
  Patch patchAt(const Corner& at) const;
  std::uint8_t boundarySidesAt(const Corner& at) const;
  void split(const Corner& at, LimitSink& sink);
  void joinFace(const Corner& at, const VertexSplit& split);
  void joinVFace(const Corner& at, const VertexSplit& split);
  void emitVFaces(LimitSink& sink);
  void emitAround(ExtraordinaryFace& face, LimitSink& sink);
  void emitBoundaryCorner(BoundaryCorner corner, CornerSquare square, LimitSink& sink);

  /// Where an active corner of an extraordinary face is.
  struct ActivePlace {
    CornerSquare square;
    std::uint8_t boundarySides = 0;
  };

  LocalImages images_;
  double tolerance_;
  FaceImages faceImages_;
  std::vector<Vec3d> facePoints_;  // level 2 in one face
  VFaceLevel vFaces_;
  std::vector<ActivePlace> vFacePlaces_, places_;  // per point of a V-face; of the face at hand
  ExtraordinaryFace around_;                       // the face at level 2, if it is not a quad
  bool joined_ = false;                            // whether around_ has active corners
  ExtraordinaryFace vFace_, next_;
  std::vector<Vec3d> innerImages_;
};

}  // namespace vox
