// The children of a vertex, as far as they are regular: which control points lie around them.

#include "libvox/subdivide/vertex_split.h"

#include <algorithm>

namespace vox {
namespace {

/// Quadrants of a child: its own face, and those of the parent's neighbours that exist.
std::uint8_t quadrants(bool q0, bool q1, bool q2, bool q3) {
  return static_cast<std::uint8_t>((q0 ? 1U : 0U) | (q1 ? 2U : 0U) | (q2 ? 4U : 0U) |
                                   (q3 ? 8U : 0U));
}

/// A patch with u and v exchanged.
Patch transposed(const Patch& patch) {
  Patch other = patch;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v) other.points[v][u] = patch.points[u][v];
  return other;
}

/// Row i of n along u, with its vertices along v.
void emitRow(const Patch& patch, std::int64_t i, std::int64_t n, int alongV, int level,
             SurfaceSink& sink) {
  const PatchWeights weights(i, n);
  CurvePoints points;
  for (std::size_t v = 0; v < 3; ++v)
    points[v] = weights(patch.points[0][v], patch.points[1][v], patch.points[2][v]);
  sink.curve(points, alongV, level + alongV);
}

void emitElongated(const Patch& patch, const PatchDepth& depth, int level, SurfaceSink& sink) {
  const Patch across = transposed(patch);
  const std::int64_t whole = std::int64_t{1} << depth.levels;
  for (const std::int64_t i : {std::int64_t{0}, whole - 1}) {
    emitRow(patch, i, whole, depth.levels, level, sink);
    emitRow(across, i, whole, depth.levels, level, sink);
  }
  // Few long rows rather than many short ones.
  const bool rowsAlongV = depth.alongU < depth.alongV;
  const std::int64_t rows = std::int64_t{1} << std::min(depth.alongU, depth.alongV);
  for (std::int64_t i = 0; i < rows; ++i)
    emitRow(rowsAlongV ? patch : across, i, rows, std::max(depth.alongU, depth.alongV), level,
            sink);
}

}  // namespace

void emitRegular(const Patch& patch, int level, SurfaceSink& sink) {
  emitRegular(patch, patchDepth(patch), level, sink);
}

void emitRegular(const Patch& patch, const PatchDepth& depth, int level, SurfaceSink& sink) {
  if (depth.levels == 0)
    sink.points({&patch.points[1][1], 1}, level);
  else if (depth.elongated())
    emitElongated(patch, depth, level, sink);
  else
    sink.patch(patch, depth.levels, level + depth.levels);
}

Patch VertexSplit::childInR() const {
  const bool ring = hasR && hasL && hasK;  // the vertex has a V-face
  return {{{{kRight, k0, l[0]}, {r[3], r[0], f0}, {r[2], r[1], fNext}}},
          quadrants(hasK, ring, true, true)};
}

Patch VertexSplit::childInL() const {
  const bool ring = hasR && hasL && hasK;
  return {{{{kLeft, l[3], l[2]}, {k0, l[0], l[1]}, {r[0], f0, fPrevious}}},
          quadrants(hasK, true, ring, true)};
}

Patch VertexSplit::childInF() const {
  const bool ring = hasR && hasL && hasK;
  return {{{{k0, l[0], l[1]}, {r[0], f0, fPrevious}, {r[1], fNext, fOpposite}}},
          quadrants(ring, hasL, hasR, true)};
}

Patch VertexSplit::childInK() const {
  return {{{{kOpposite, kLeft, l[3]}, {kRight, k0, l[0]}, {r[3], r[0], f0}}},
          quadrants(true, hasL, hasR, hasR && hasL)};
}

void VertexSplit::emitSides(int level, SurfaceSink& sink) const {
  if (hasR) emitRegular(childInR(), level, sink);
  if (hasL) emitRegular(childInL(), level, sink);
}

void VertexSplit::emitInF(int level, SurfaceSink& sink) const {
  emitRegular(childInF(), level, sink);
}

void VertexSplit::emitInK(int level, SurfaceSink& sink) const {
  if (hasK) emitRegular(childInK(), level, sink);
}

}  // namespace vox
