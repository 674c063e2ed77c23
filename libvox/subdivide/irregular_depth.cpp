// The depth of an irregular vertex: the largest of the depths of its children, level by level.

#include "libvox/subdivide/irregular_depth.h"

#include <algorithm>
#include <array>

namespace vox {
namespace {

VertexFaces facesOf(const FaceCorner& corner, int level) {
  VertexFaces faces(corner.around);
  const auto& p = corner.around.points;
  faces.f = corner.face.shape(level);
  faces.vFace = shapeOf(std::array<Vec3d, 4>{p[1][1], p[0][1], p[0][0], p[1][0]});
  return faces;
}

VertexFaces facesOf(const BoundaryCorner& corner, int /*level*/) {
  VertexFaces faces(corner.around());
  faces.r = {faces.at, faces.next, corner.mRight, corner.mStart};
  faces.l = {faces.at, faces.previous, corner.mLeft, corner.mEnd};
  faces.f = shapeOf(std::array<Vec3d, 4>{corner.u, corner.right, corner.opposite, corner.left});
  faces.vFace = shapeOf(std::array<Vec3d, 3>{corner.u, corner.mEnd, corner.mStart});
  return faces;
}

/// Depth of an irregular vertex for one criterion: it only rises while descendants are visited.
class IrregularDepth {
 public:
  IrregularDepth(const Criterion& criterion, int most) : criterion_(criterion), most_(most) {}

  int depth() const { return depth_; }

  void regular(const Patch& patch, int level, const CornerSquare& /*square*/) {
    const int below = level - 1;
    depth_ = below < most_ ? std::max(depth_, below + criterion_.squareDepth(patch, most_ - below))
                           : most_;
  }

  template <class Corner>
  bool ends(const Corner& corner, int level, const CornerSquare& /*square*/) {
    if (depth_ >= most_) return true;
    if (depth_ > level - 1 || !criterion_.fine(facesOf(corner, level))) return false;
    depth_ = level - 1;
    return true;
  }

 private:
  const Criterion& criterion_;
  int most_;
  int depth_ = 1;
};

}  // namespace

int irregularDepth(const Criterion& criterion, const LevelOneVertex& vertex,
                   const VertexFaces& faces, int most) {
  if (most == 0 || criterion.fine(faces)) return 0;
  IrregularDepth depth(criterion, most);
  Descent(depth).below(vertex, {});
  return depth.depth();
}

}  // namespace vox
