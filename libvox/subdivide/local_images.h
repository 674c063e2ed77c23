#pragma once

#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/level.h"

#include <span>
#include <vector>

namespace vox {

/// Level 1 of a submesh: the images of its faces, of its one-ring as far as somebody asks, and the
/// faces that they form around edges and vertices. The base mesh is only read; work arrays are kept
/// from one submesh to the next. Whatever the submesh, an image has the same bits.
class LocalImages {
 public:
  /// The level-1 face around a vertex: its V-face, or at the boundary of an extended surface the
  /// half V-face with its mirror image: n = 2m corners for m > 1 faces, of which the first m are
  /// real.
  struct VFace {
    Index begin = 0;  ///< of its points in vFacePoints
    Index size = 0;   ///< n; with m = 1, or without a V-face (at a free boundary), the fan itself
    Index fan = 0;    ///< m, real corners
    bool closed = false;
    double diameter = 0;           ///< of its real half, with the two points on the boundary
    Vec3d mStart = Vec3d::Zero();  ///< the point on the boundary edge that leaves
    Vec3d mEnd = Vec3d::Zero();    ///< and on the one that arrives

    /// Of the points beside the one at a place, counter-clockwise.
    Index before(Index place) const { return begin + (place == 0 ? size : place) - 1; }
    Index after(Index place) const { return begin + (place + 1 == size ? 0 : place + 1); }
  };
  /// The level-1 face across the edge of a corner, or the mirrored half face at an extended
  /// boundary.
  struct EdgeFace {
    Vec3d near = Vec3d::Zero();  ///< the point across from the corner
    Vec3d far = Vec3d::Zero();   ///< the point across from the next corner
    double diameter = 0;         ///< of its real half
    bool exists = true;
    bool interior = false;  ///< no boundary edge
  };

  /// @param base  level 0: an oriented manifold with one fan of faces at each vertex
  explicit LocalImages(const SubdivisionLevel& base);

  /// Replaces the submesh. Cost: its corners, and those of its one-ring.
  void set(std::span<const Index> faces);

  const SubdivisionLevel& base() const { return base_; }
  std::span<const Index> faces() const { return faces_; }
  bool extends() const { return base_.boundary == BoundaryStage::kExtend; }

  /// Slots 0 .. ownSlots() - 1 are the corners of the submesh, face by face.
  Index ownSlots() const { return ownSlots_; }
  /// Of a face of the submesh, its first one.
  Index firstSlot(Index face) const { return firstSlot_[face]; }
  const Vec3d& image(Index slot) const { return images_[slot]; }
  std::span<const Vec3d> imagesOfFace(Index firstSlot, Index size) const {
    return std::span(images_).subspan(firstSlot, size);
  }
  const EdgeFace& edgeFace(Index slot) const { return edges_[slot]; }
  const VFace& vFace(Index slot) const { return vFaces_[vFaceOf_[slot]]; }
  Index vFaceNumber(Index slot) const { return vFaceOf_[slot]; }
  Index placeInVFace(Index slot) const { return placeInVFace_[slot]; }

  const std::vector<VFace>& vFaces() const { return vFaces_; }
  /// Level-1 points around the vertices, counter-clockwise; a fan starts at the boundary edge that
  /// leaves the vertex.
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
  std::span<const Index> faces_;
  Index ownSlots_ = 0;
  std::vector<Index> firstSlot_;  // per face of the base, or kNone
  std::vector<Index> known_;      // faces that have slots
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
