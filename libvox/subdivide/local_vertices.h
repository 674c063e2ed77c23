#pragma once

#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/local_images.h"
#include "libvox/subdivide/vertex_array.h"

#include <deque>
#include <span>
#include <vector>

namespace vox {

/// The level-1 vertices of a submesh with what lies around them, and of their neighbours beyond it
/// what the faces between them depend on. The base mesh must have no interior vertex of two faces.
/// One object per thread; work arrays are kept. Whatever the submesh, points have the same bits.
class LocalVertices {
 public:
  explicit LocalVertices(const SubdivisionLevel& base) : images_(base) {}

  /// Replaces the submesh. Cost: that of LocalImages.
  void set(std::span<const Index> faces);
  /// The same with faces beyond it after those of the submesh, so that corners can be asked for
  /// across its edges, and all around vertices whose fan begins in it. What a vertex refers to is
  /// valid until the next submesh.
  void setWithNeighbours(std::span<const Index> faces);

  const LocalImages& images() const { return images_; }

  /// A corner of a face of the submesh, by slots.
  struct Corner {
    Index first;   ///< slot of the face's first corner
    Index place;   ///< in the face
    Index size;    ///< of the face
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

  /// A corner of a loaded face.
  Corner cornerOf(Index number) const {
    const SubdivisionLevel& base = images_.base();
    const Index f = base.adjacency.cornerFace[number];
    return {images_.firstSlot(f), number - base.mesh.faceOffsets[f], base.mesh.faceSize(f), number};
  }

  /// A vertex of the submesh. What it refers to is valid until a corner of another face is asked
  /// for.
  LevelOneVertex at(const Corner& corner);
  /// The neighbour across R, near which it is known as far as R and the V-face go: its L and
  /// V-face.
  LevelOneVertex acrossR(const Corner& corner);
  /// The neighbour across R of the vertex at the next corner, as far as R goes.
  LevelOneVertex acrossRFromNext(const Corner& corner);
  /// A vertex of a V-face, as far as the V-face goes.
  LevelOneVertex inVFace(Index vFace, Index place, bool quadF);

  /// What stop rules look at.
  VertexFaces facesAt(const Corner& corner);
  BoundaryCurves curvesAt(const Corner& corner) const;
  /// Boundary points across R and L of a corner, with their neighbours along the boundary.
  CurvePoints curveAcrossR(const Corner& corner) const;
  CurvePoints curveAcrossL(const Corner& corner) const;

  bool hasVFace(Index slot) const { return images_.vFace(slot).closed || images_.extends(); }
  bool isBoundary(const Corner& corner) const {
    return images_.base().adjacency.twin[corner.number] == kNone;
  }

 private:
  void load(std::span<const Index> faces);
  void addFansFrom(std::span<const Index> faces);
  void addNeighbour(Index face);
  void prepareVFaces();
  void surroundVFaces(std::vector<ExtraordinaryFace>& faces) const;
  Index sizeOfVFace(const LocalImages::VFace& vFace) const {
    return vFace.closed || images_.extends() ? vFace.size : 4;
  }
  Patch patchAt(const Corner& corner) const;
  void splitVFace(const LocalImages::VFace& vFace, Index number, Index place,
                  LevelOneVertex& vertex);
  ExtraordinaryLevels& levelsOf(const Corner& corner);
  void openFace(const Corner& corner, ExtraordinaryLevels& levels);
  void shapeVFace(Index number);

  LocalImages images_;
  FaceImages faceImages_;
  std::vector<Vec3d> second_;       // level 2 in the faces, per slot
  std::vector<Vec3d> vFaceSecond_;  // level 2 in the V-faces, per point
  std::vector<ExtraordinaryLevels> vFaceLevels_;
  std::vector<FaceShape> vFaceShapes_;
  std::vector<std::uint8_t> vFaceShaped_;
  // Of faces that are no quads: of one at a time, or with neighbours of all that were asked for.
  std::deque<ExtraordinaryLevels> faceLevels_ = std::deque<ExtraordinaryLevels>(1);
  Index openFace_ = kNone;       // first slot of the face of the first of these
  bool keepsLevels_ = false;     // of all
  std::vector<Index> levelsAt_;  // by first slot
  std::size_t opened_ = 0;
  FaceShape faceShape_;
  Index shapedFace_ = kNone;
  // With neighbours:
  std::vector<Index> loaded_, loadedBefore_;
  std::vector<std::uint8_t> isLoaded_;   // per face of the base
  std::vector<std::uint8_t> isVisited_;  // per vertex
};

}  // namespace vox
