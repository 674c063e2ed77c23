// Steps at level-1 vertices and at corners of extraordinary faces.

#include "libvox/subdivide/level_one_vertex.h"

#include "libvox/core/error.h"
#include "libvox/subdivide/face_images.h"

#include <string>

namespace vox {

VertexSplit LevelOneVertex::split() const {
  VertexSplit split(around);
  if (face != nullptr) split.setF(face->corners(2), place);
  if (vFace != nullptr) split.setVFace(vFace->corners(2), placeInVFace);
  if (triangle)
    TriangleImages(around.points[1][1], triangle->mStart, triangle->mEnd).setVFace(split);
  return split;
}

VertexSplit FaceCorner::split(int level) const {
  VertexSplit split(around);
  split.setF(face.corners(level + 1), place);
  const auto& p = around.points;
  split.setVFace(quadImages(p[1][1], p[1][0], p[0][0], p[0][1]));
  return split;
}

void requireLevelInRange(int level) {
  constexpr int kDeepestLevel = 64;
  if (level > kDeepestLevel)
    throw LimitError("the surface needs more than " + std::to_string(kDeepestLevel) +
                     " subdivision levels; use larger voxels");
}

}  // namespace vox
