// The patches of the children of a vertex, as far as they are regular.

#include "libvox/subdivide/vertex_split.h"

#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/thin_patch.h"

namespace vox {
namespace {

/// The set of the quadrants that exist.
std::uint8_t quadrants(bool q0, bool q1, bool q2, bool q3) {
  return static_cast<std::uint8_t>((q0 ? 1U : 0U) | (q1 ? 2U : 0U) | (q2 ? 4U : 0U) |
                                   (q3 ? 8U : 0U));
}

/// Emits the rows as curves; the columns are rows of the patch turned by a quarter.
void emitThin(const ThinPatch& thin, int level, SurfaceSink& sink) {
  const int k = thin.levels;
  const std::int64_t n = std::int64_t{1} << k;
  for (const std::int64_t i : thin.rows) sink.curve(rowOf(thin.patch, {i, n}), k, level + k);
  const Patch across = quarterTurn(thin.patch);
  for (const std::int64_t j : {std::int64_t{0}, n - 1})
    sink.curve(rowOf(across, {j, n}), k, level + k);
}

}  // namespace

void emitRegular(const Patch& patch, int level, SurfaceSink& sink) {
  forEachPatchPart(
      PatchPart(patch), level,
      [&](const ThinPatch& thin, int levelOfPart) { emitThin(thin, levelOfPart, sink); },
      [&](const Patch& part, int levels, int levelOfPart) {
        if (levels == 0)
          sink.points({&part.points[1][1], 1}, levelOfPart);
        else
          sink.patch(part, levels, levelOfPart + levels);
      });
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

void VertexSplit::emitSides(int level, SurfaceSink& sink) const {
  if (hasR) emitRegular(childInR(), level, sink);
  if (hasL) emitRegular(childInL(), level, sink);
}

void VertexSplit::emitInF(int level, SurfaceSink& sink) const {
  emitRegular(childInF(), level, sink);
}

void VertexSplit::emitInVFace(int level, SurfaceSink& sink) const {
  if (hasVFace) emitRegular(childInVFace(), level, sink);
}

}  // namespace vox
