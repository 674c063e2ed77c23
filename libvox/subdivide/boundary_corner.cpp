// Vertices in the triangle at a boundary vertex with one face.

#include "libvox/subdivide/boundary_corner.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/face_images.h"

namespace vox {

TriangleImages::TriangleImages(const Vec3d& at, const Vec3d& start, const Vec3d& end)
    : u((2.0 * at + start + end) / 4.0), mStart(chaikin(start, end)), mEnd(chaikin(end, start)) {}

void TriangleImages::setVFace(VertexSplit& split) const {
  split.vFace0 = u;
  split.vFaceRight = mirrored(u, mStart);
  split.vFaceLeft = mirrored(u, mEnd);
}

BoundaryCorner TriangleImages::below(const VertexSplit& split) const {
  return {u,
          mStart,
          mEnd,
          split.r[0],
          middle(split.r[0], split.r[3]),
          split.l[0],
          middle(split.l[0], split.l[3]),
          split.f0};
}

Patch BoundaryCorner::around() const {
  return {{{{u, mirrored(u, mEnd), mirrored(left, mLeft)},
            {mirrored(u, mStart), u, left},
            {mirrored(right, mRight), right, opposite}}}};
}

VertexSplit BoundaryCorner::split() const {
  VertexSplit split(around());
  split.setF(quadImages(u, right, opposite, left));
  TriangleImages(u, mStart, mEnd).setVFace(split);
  return split;
}

BoundaryCorner BoundaryCorner::below(const VertexSplit& split) const {
  const TriangleImages t(u, mStart, mEnd);
  // mRight and mLeft: the children of the corners of the strips.
  return {t.u,
          t.mStart,
          t.mEnd,
          split.r[0],
          chaikin(mStart, mRight),
          split.l[0],
          chaikin(mEnd, mLeft),
          split.f0};
}

}  // namespace vox
