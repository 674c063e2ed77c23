#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/level.h"

#include <span>
#include <vector>

namespace vox {

/// A corner of a face of a submesh. Corners have slots (LocalImages), face by face.
struct SubmeshCorner {
  Index first;   ///< slot of the first corner of the face
  Index place;   ///< of the corner in the face
  Index size;    ///< number of corners of the face
  Index number;  ///< of the corner in the base mesh

  Index slot() const { return first + place; }
  Index nextSlot() const { return place + 1 == size ? first : first + place + 1; }
  Index previousSlot() const { return (place == 0 ? first + size : first + place) - 1; }
  Index oppositeSlot() const { return first + (place ^ 2U); }  ///< in a quad
  SubmeshCorner next() const { return at(nextSlot() - first); }
  SubmeshCorner previous() const { return at(previousSlot() - first); }
  /// Another corner of the face.
  SubmeshCorner at(Index other) const { return {first, other, size, number - place + other}; }
};

/// Level 1 of a submesh: the image vertices of its faces and of the faces of its one-ring, and the
/// V-faces and E-faces that they form. The base mesh is only read. Work arrays are kept from one
/// submesh to the next. An image vertex has the same bits in every submesh. One object per thread.
class LocalImages {
 public:
  /// The V-face of a vertex. At the boundary of an extended surface: the half V-face with its
  /// mirror image, a polygon of 2m corners for a fan of m > 1 faces; the first m corners are real.
  struct VFace {
    Index begin = 0;               ///< index of its first point in vFacePoints
    Index size = 0;                ///< number of its points: 2m if it has a mirror image, else m
    Index fan = 0;                 ///< m, the number of real corners
    bool closed = false;           ///< whether the vertex is interior
    double diameter = 0;           ///< L-inf; of the real half, with the two points on the boundary
    Vec3d mStart = Vec3d::Zero();  ///< point on the boundary edge that leaves the vertex
    Vec3d mEnd = Vec3d::Zero();    ///< point on the boundary edge that arrives at the vertex

    /// Indices in vFacePoints of the points before and after the one at a place, counter-clockwise.
    Index before(Index place) const { return begin + (place == 0 ? size : place) - 1; }
    Index after(Index place) const { return begin + (place + 1 == size ? 0 : place + 1); }
  };
  /// The E-face across the edge of a corner. At an extended boundary: the half E-face with its
  /// mirror image.
  struct EdgeFace {
    Vec3d near = Vec3d::Zero();  ///< neighbour, in this face, of the image vertex of the corner
    Vec3d far = Vec3d::Zero();   ///< neighbour of the image vertex of the next corner
    double diameter = 0;         ///< L-inf; of the real half
    bool exists = true;          ///< false at a free boundary
    bool interior = false;       ///< whether the edge is interior
  };

  /// @param base  level 0: an oriented manifold with one fan of faces at each vertex
  explicit LocalImages(const SubdivisionLevel& base);

  /// Replaces the submesh. Cost linear in the corners of the submesh and its one-ring.
  /// @param faces  of the base
  void set(std::span<const Index> faces);

  const SubdivisionLevel& base() const { return base_; }
  bool extends() const { return base_.boundary == BoundaryStage::kExtend; }

  const Vec3d& image(Index slot) const { return images_[slot]; }
  std::span<const Vec3d> imagesOfFace(Index firstSlot, Index size) const {
    return std::span(images_).subspan(firstSlot, size);
  }
  const EdgeFace& edgeFace(Index slot) const { return edges_[slot]; }
  const VFace& vFace(Index slot) const { return vFaces_[vFaceOf_[slot]]; }
  Index vFaceNumber(Index slot) const { return vFaceOf_[slot]; }
  Index placeInVFace(Index slot) const { return placeInVFace_[slot]; }
  bool hasVFace(Index slot) const { return vFace(slot).closed || extends(); }

  /// Calls body(corner) with the first corner of each face of the submesh.
  template <class Body>
  void forEachFace(const Body& body) const {
    Index slot = 0;
    for (const Index f : faces_) {
      const Index size = base_.mesh.faceSize(f);
      body(SubmeshCorner{slot, 0, size, base_.mesh.faceOffsets[f]});
      slot += size;
    }
  }

  /// Whether the face of a corner and its V-face, if there is one, are quads.
  bool isRegular(const SubmeshCorner& at) const {
    return at.size == 4 && (!hasVFace(at.slot()) || vFace(at.slot()).size == 4);
  }
  /// The patch around the level-1 vertex of a corner of the submesh. Of a face that is not a quad,
  /// the corner opposite the vertex has no meaning.
  Patch around(const SubmeshCorner& at) const;

  const std::vector<VFace>& vFaces() const { return vFaces_; }
  /// Points of the V-faces, counter-clockwise; an open fan starts at the boundary edge that leaves
  /// the vertex.
  const std::vector<Vec3d>& vFacePoints() const { return vFacePoints_; }

 private:
  Index slotOfFace(Index f);
  Vec3d imageAt(Index corner);
  void addFace(Index f);
  void addVFace(Index corner);
  bool findFan(Index corner);
  void closeFan(VFace& vFace);
  void addEdge(Index slot, Index next, Index corner);
  void mirrorEdge(Index slot, Index next, Index corner);

  const SubdivisionLevel& base_;
  std::vector<Index> faces_;      // a copy: the next set() undoes what they have set
  Index ownSlots_ = 0;            // corners of the submesh; their slots are the first ones
  std::vector<Index> firstSlot_;  // per face of the base, or kNone
  std::vector<Index> known_;      // faces with slots
  std::vector<Index> vFaceAt_;    // per vertex of the base, or kNone
  std::vector<Vec3d> images_;
  std::vector<EdgeFace> edges_;
  std::vector<Index> vFaceOf_;
  std::vector<Index> placeInVFace_;
  std::vector<VFace> vFaces_;
  std::vector<Vec3d> vFacePoints_;
  std::vector<Index> fan_;
  std::vector<Vec3d> corners_;
  FaceImages faceImages_;
};

}  // namespace vox
