// The images around a vertex, and the patches of its children.

#include "libvox/subdivide/vertex_split.h"

#include "libvox/subdivide/face_images.h"

namespace vox {
namespace {

/// The set of the quadrants that exist.
std::uint8_t quadrants(bool q0, bool q1, bool q2, bool q3) {
  return static_cast<std::uint8_t>((q0 ? 1U : 0U) | (q1 ? 2U : 0U) | (q2 ? 4U : 0U) |
                                   (q3 ? 8U : 0U));
}

/// The points of a face at a corner, at the next one, opposite it in a quad (else 0), and at the
/// previous one.
std::array<Vec3d, 4> fromCorner(std::span<const Vec3d> points, std::size_t place) {
  const std::size_t n = points.size();
  return {points[place], points[place + 1 == n ? 0 : place + 1],
          n == 4 ? points[place ^ 2U] : Vec3d::Zero(), points[(place == 0 ? n : place) - 1]};
}

}  // namespace

VertexSplit::VertexSplit(const Patch& around)
    : hasR((around.quadrants & 4U) != 0),
      hasL((around.quadrants & 2U) != 0),
      hasVFace((around.quadrants & 1U) != 0) {
  const auto& p = around.points;
  r = quadImages(p[1][1], p[2][1], p[2][0], p[1][0]);
  l = quadImages(p[1][1], p[1][2], p[0][2], p[0][1]);
}

void VertexSplit::setF(std::span<const Vec3d> images, std::size_t place) {
  setF(fromCorner(images, place));
}

void VertexSplit::setVFace(std::span<const Vec3d> images, std::size_t place) {
  const auto [at, left, opposite, right] = fromCorner(images, place);
  setVFace({at, right, opposite, left});
}

Patch VertexSplit::childInR() const {
  const bool interior = hasR && hasL && hasVFace;  // the vertex makes a V-face
  return {{{{vFaceRight, vFace0, l[0]}, {r[3], r[0], f0}, {r[2], r[1], fNext}}},
          quadrants(hasVFace, interior, true, true)};
}

Patch VertexSplit::childInL() const {
  const bool interior = hasR && hasL && hasVFace;
  return {{{{vFaceLeft, l[3], l[2]}, {vFace0, l[0], l[1]}, {r[0], f0, fPrevious}}},
          quadrants(hasVFace, true, interior, true)};
}

Patch VertexSplit::childInF() const {
  const bool interior = hasR && hasL && hasVFace;
  return {{{{vFace0, l[0], l[1]}, {r[0], f0, fPrevious}, {r[1], fNext, fOpposite}}},
          quadrants(interior, hasL, hasR, true)};
}

Patch VertexSplit::childInVFace() const {
  return {{{{vFaceOpposite, vFaceLeft, l[3]}, {vFaceRight, vFace0, l[0]}, {r[3], r[0], f0}}},
          quadrants(true, hasL, hasR, hasR && hasL)};
}

}  // namespace vox
