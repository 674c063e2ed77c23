// The children of a vertex, as far as they are regular: which control points lie around them.

#include "libvox/subdivide/vertex_split.h"

#include "libvox/subdivide/stop.h"

namespace vox {
namespace {

/// Quadrants of a child: its own face, and those of the parent's neighbours that exist.
std::uint8_t quadrants(bool q0, bool q1, bool q2, bool q3) {
  return static_cast<std::uint8_t>((q0 ? 1U : 0U) | (q1 ? 2U : 0U) | (q2 ? 4U : 0U) |
                                   (q3 ? 8U : 0U));
}

}  // namespace

void emitRegular(const Patch& patch, int level, SurfaceSink& sink) {
  const int k = patchDepth(patch);
  if (k == 0)
    sink.points({&patch.points[1][1], 1}, level);
  else
    sink.patch(patch, k, level + k);
}

void VertexSplit::emitSides(int level, SurfaceSink& sink) const {
  const bool ring = hasR && hasL && hasK;  // the vertex has a V-face
  if (hasR)
    emitRegular({{{{kRight, k0, l[0]}, {r[3], r[0], f0}, {r[2], r[1], fNext}}},
                 quadrants(hasK, ring, true, true)},
                level, sink);
  if (hasL)
    emitRegular({{{{kLeft, l[3], l[2]}, {k0, l[0], l[1]}, {r[0], f0, fPrevious}}},
                 quadrants(hasK, true, ring, true)},
                level, sink);
}

void VertexSplit::emitInF(int level, SurfaceSink& sink) const {
  const bool ring = hasR && hasL && hasK;
  emitRegular({{{{k0, l[0], l[1]}, {r[0], f0, fPrevious}, {r[1], fNext, fOpposite}}},
               quadrants(ring, hasL, hasR, true)},
              level, sink);
}

void VertexSplit::emitInK(int level, SurfaceSink& sink) const {
  if (!hasK) return;
  const bool ring = hasR && hasL;
  emitRegular({{{{kOpposite, kLeft, l[3]}, {kRight, k0, l[0]}, {r[3], r[0], f0}}},
               quadrants(true, hasL, hasR, ring)},
              level, sink);
}

}  // namespace vox
