#pragma once

#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/face_levels.h"
#include "libvox/subdivide/level_one_vertex.h"
#include "libvox/subdivide/local_images.h"

#include <span>
#include <vector>

namespace vox {

/// The level-1 vertices of a submesh and the faces around them; also those vertices beyond the
/// submesh that its strips and polygons use. Points have the same bits in every submesh. What lies
/// below level 1 is made when first asked for. One object per thread; work arrays are kept.
class LocalVertices {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  ///   vertex, and no interior vertex of two faces
  explicit LocalVertices(const SubdivisionLevel& base) : images_(base) {}

  /// Replaces the submesh. Cost as LocalImages::set.
  /// @param faces  of the base
  void set(std::span<const Index> faces);

  const LocalImages& images() const { return images_; }

  /// The level-1 vertex of a corner. Its pointers are valid until at() is called for a corner of
  /// another face.
  LevelOneVertex at(const SubmeshCorner& corner);

  // Level-1 vertices of faces beyond the submesh. Only some of the faces around them are known:

  /// The neighbour across R of the vertex of a corner, at the same base vertex. Known are its
  /// V-face and its L, which is the R of the corner.
  LevelOneVertex acrossR(const SubmeshCorner& corner);
  /// The neighbour across R of the vertex of the next corner. Known are its V-face and its R, which
  /// is the R of `corner`.
  LevelOneVertex acrossRFromNext(const SubmeshCorner& corner);
  /// The vertex at a place of a V-face. Known is only its V-face.
  /// @param vFace  number of the V-face (LocalImages)
  /// @param quadF  whether its F-face is a quad
  LevelOneVertex inVFace(Index vFace, Index place, bool quadF);

  /// The faces around the vertex of a corner, for stop rules.
  VertexFaces facesAt(const SubmeshCorner& corner);
  /// The boundary points beside the vertex of a corner; none unless the surface is extended.
  BoundaryCurves curvesAt(const SubmeshCorner& corner) const;
  /// The boundary points across R and L of a corner, with their neighbours along the boundary.
  /// Precondition: the surface is extended, and the edge in question is boundary.
  CurvePoints curveAcrossR(const SubmeshCorner& corner) const;
  CurvePoints curveAcrossL(const SubmeshCorner& corner) const;

  bool isBoundary(const SubmeshCorner& corner) const {
    return images_.base().adjacency.twin[corner.number] == kNone;
  }

 private:
  FaceLevels& faceOf(const SubmeshCorner& corner);
  FaceLevels& levelsOfVFace(Index number);
  void setVFace(Index number, Index place, LevelOneVertex& vertex);

  LocalImages images_;
  FaceLevels face_;                 // of the last face that was asked for
  Index firstOfFace_ = kNone;       // its first slot
  std::vector<FaceLevels> vFaces_;  // per V-face; empty until asked for
};

}  // namespace vox
