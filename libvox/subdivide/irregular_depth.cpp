// The depth of an irregular vertex: the largest of the depths of its children, level by level.

#include "libvox/subdivide/irregular_depth.h"

#include "libvox/mesh/chaikin.h"

#include <algorithm>
#include <array>

namespace vox {
namespace {

/// The faces around corner i of an extraordinary face.
VertexFaces facesOf(const ExtraordinaryLevels::Level& level, std::size_t i) {
  const ExtraordinaryFace& face = level.face;
  const std::size_t j = face.before(i);
  const std::size_t n = face.after(i);
  VertexFaces faces{face.inner[i],
                    face.inner[n],
                    face.inner[j],
                    face.near[i],
                    face.far[j],
                    level.shape,
                    {},
                    {},
                    {}};
  faces.r = {faces.at, faces.next, face.far[i], face.near[i]};
  faces.l = {faces.at, faces.previous, face.near[j], face.far[j]};
  faces.vFace = shapeOf(std::array<Vec3d, 4>{faces.at, faces.left, face.corner[i], faces.right});
  faces.hasR = face.hasEdge[i];
  faces.hasL = face.hasEdge[j];
  faces.hasVFace = face.hasCorner[i];
  return faces;
}

VertexFaces facesOf(const BoundaryCorner& corner) {
  VertexFaces faces{corner.u,
                    corner.right,
                    corner.left,
                    mirrored(corner.u, corner.mStart),
                    mirrored(corner.u, corner.mEnd),
                    {},
                    {},
                    {},
                    {}};
  faces.r = {faces.at, faces.next, corner.mRight, corner.mStart};
  faces.l = {faces.at, faces.previous, corner.mLeft, corner.mEnd};
  faces.f = shapeOf(std::array<Vec3d, 4>{corner.u, corner.right, corner.opposite, corner.left});
  faces.vFace = shapeOf(std::array<Vec3d, 3>{corner.u, corner.mEnd, corner.mStart});
  return faces;
}

/// Depth of an irregular vertex for one criterion: depth_ only rises while descendants are visited.
class IrregularDepth {
 public:
  IrregularDepth(const Criterion& criterion, int most) : criterion_(criterion), most_(most) {}

  int of(const LevelOneVertex& vertex, const VertexFaces& faces) {
    if (most_ == 0 || criterion_.fine(faces)) return 0;
    depth_ = 1;
    const VertexSplit& split = vertex.split;
    if (split.hasR) take(split.childInR(), 1);
    if (split.hasL) take(split.childInL(), 1);
    if (vertex.quadF)
      take(split.childInF(), 1);
    else
      takeLevels(*vertex.levelsOfF, vertex.placeInF);
    if (!split.hasVFace) return depth_;
    if (vertex.corner)
      takeCorner(*vertex.corner);
    else if (vertex.quadVFace)
      take(split.childInVFace(), 1);
    else
      takeLevels(*vertex.levelsOfVFace, vertex.placeInVFace);
    return depth_;
  }

 private:
  /// Takes a regular vertex that is `below` levels down.
  void take(const Patch& patch, int below) {
    if (below < most_)
      depth_ = std::max(depth_, below + criterion_.squareDepth(patch, most_ - below));
    else
      depth_ = most_;
  }

  void takeLevels(ExtraordinaryLevels& levels, std::size_t place) {
    for (int l = 0; depth_ < most_; ++l) {
      if (depth_ <= l + 1 && criterion_.fine(facesOf(levels.level(l), place))) {
        depth_ = l + 1;
        return;
      }
      const VertexSplit split = levels.split(l, place);
      if (split.hasR) take(split.childInR(), l + 2);
      if (split.hasL) take(split.childInL(), l + 2);
      if (split.hasVFace) take(split.childInVFace(), l + 2);
    }
  }

  void takeCorner(BoundaryCorner corner) {
    for (int l = 0; depth_ < most_; ++l) {
      if (depth_ <= l + 1 && criterion_.fine(facesOf(corner))) {
        depth_ = l + 1;
        return;
      }
      const VertexSplit split = corner.split();
      for (const Patch& child : {split.childInR(), split.childInL(), split.childInF()})
        take(child, l + 2);
      corner = corner.below(split);
    }
  }

  const Criterion& criterion_;
  int most_;
  int depth_ = 0;
};

}  // namespace

int irregularDepth(const Criterion& criterion, const LevelOneVertex& vertex,
                   const VertexFaces& faces, int most) {
  return IrregularDepth(criterion, most).of(vertex, faces);
}

}  // namespace vox
