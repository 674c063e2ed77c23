#pragma once

#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/local_images.h"
#include "libvox/subdivide/vertex_array.h"

#include <span>
#include <vector>

namespace vox {

/// The level-1 vertices of a submesh and the faces around them; also those vertices beyond the
/// submesh that its strips and polygons use. Points have the same bits in every submesh. One object
/// per thread; work arrays are kept.
class LocalVertices {
 public:
  /// @param base  level 0, without interior vertices of two faces
  explicit LocalVertices(const SubdivisionLevel& base) : images_(base) {}

  /// Replaces the submesh. Cost as LocalImages::set.
  /// @param faces  of the base; the span must stay valid until the next call
  void set(std::span<const Index> faces);

  const LocalImages& images() const { return images_; }

  /// A corner of the submesh.
  struct Corner {
    Index first;   ///< slot of the first corner of the face (LocalImages)
    Index place;   ///< of the corner in the face
    Index size;    ///< number of corners of the face
    Index number;  ///< of the corner in the base mesh
    Index slot() const { return first + place; }
    Corner next() const {
      return place + 1 == size ? Corner{first, 0, size, number - place}
                               : Corner{first, place + 1, size, number + 1};
    }
    Corner previous() const {
      return place == 0 ? Corner{first, size - 1, size, number + size - 1}
                        : Corner{first, place - 1, size, number - 1};
    }
  };

  /// The level-1 vertex of a corner. Its pointers are valid until at() is called for a corner of
  /// another face.
  LevelOneVertex at(const Corner& corner);

  // Level-1 vertices of faces beyond the submesh. Only some of the faces around them are known:

  /// The neighbour across R of the vertex of a corner, at the same base vertex. Known are its
  /// V-face and its L, which is the R of the corner.
  LevelOneVertex acrossR(const Corner& corner);
  /// The neighbour across R of the vertex of the next corner. Known are its V-face and its R, which
  /// is the R of `corner`.
  LevelOneVertex acrossRFromNext(const Corner& corner);
  /// The vertex at a place of a V-face. Known is only its V-face.
  /// @param vFace  number of the V-face (LocalImages)
  /// @param quadF  whether its F-face is a quad
  LevelOneVertex inVFace(Index vFace, Index place, bool quadF);

  /// The faces around the vertex of a corner, for stop rules.
  VertexFaces facesAt(const Corner& corner);
  /// The boundary points beside the vertex of a corner; none unless the surface is extended.
  BoundaryCurves curvesAt(const Corner& corner) const;
  /// The boundary points across R and L of a corner, with their neighbours along the boundary.
  /// Precondition: the surface is extended, and the edge in question is boundary.
  CurvePoints curveAcrossR(const Corner& corner) const;
  CurvePoints curveAcrossL(const Corner& corner) const;

  bool isBoundary(const Corner& corner) const {
    return images_.base().adjacency.twin[corner.number] == kNone;
  }

 private:
  void prepareVFaces();
  void surroundVFaces(std::vector<ExtraordinaryFace>& faces) const;
  Index sizeOfVFace(const LocalImages::VFace& vFace) const {
    return vFace.closed || images_.extends() ? vFace.size : 4;
  }
  void splitVFace(const LocalImages::VFace& vFace, Index number, Index place,
                  LevelOneVertex& vertex);
  void openFace(const Corner& corner);
  void shapeVFace(Index number);

  LocalImages images_;
  FaceImages faceImages_;
  std::vector<Vec3d> second_;       // level 2 in the faces, per slot
  std::vector<Vec3d> vFaceSecond_;  // level 2 in the V-faces, per point
  std::vector<ExtraordinaryLevels> vFaceLevels_;
  std::vector<FaceShape> vFaceShapes_;
  std::vector<std::uint8_t> vFaceShaped_;
  ExtraordinaryLevels faceLevels_;  // of the last face that is not a quad
  Index openFace_ = kNone;          // its first slot
  FaceShape faceShape_;
  Index shapedFace_ = kNone;
};

}  // namespace vox
