// Patches derived from a patch: turned, halved, refined.

#include "libvox/mesh/patch_parts.h"

#include "libvox/mesh/chaikin.h"

namespace vox {
namespace {

/// One refinement step of three control points.
std::array<Vec3d, 4> refine(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {chaikin(a, b), chaikin(b, a), chaikin(b, c), chaikin(c, b)};
}

}  // namespace

Patch quarterTurn(const Patch& patch) {
  Patch turned;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v) turned.points[u][v] = patch.points[v][2 - u];
  return turned;
}

Patch halfTurn(const Patch& patch) {
  Patch turned;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v) turned.points[u][v] = patch.points[2 - u][2 - v];
  turned.quadrants = 0;
  for (unsigned q = 0; q < 4; ++q)
    if ((patch.quadrants >> q & 1U) != 0) turned.quadrants |= static_cast<std::uint8_t>(8U >> q);
  return turned;
}

std::array<Patch, 2> halvesAlongU(const Patch& patch) {
  std::array<Patch, 2> halves;
  for (std::size_t v = 0; v < 3; ++v) {
    const auto fine = refine(patch.points[0][v], patch.points[1][v], patch.points[2][v]);
    for (std::size_t u = 0; u < 3; ++u) {
      halves[0].points[u][v] = fine[u];
      halves[1].points[u][v] = fine[u + 1];
    }
  }
  return halves;
}

std::array<std::array<Patch, 2>, 2> childrenOf(const Patch& patch) {
  std::array<std::array<Vec3d, 4>, 3> along;
  for (std::size_t u = 0; u < 3; ++u)
    along[u] = refine(patch.points[u][0], patch.points[u][1], patch.points[u][2]);
  std::array<std::array<Vec3d, 4>, 4> fine;  // [v][u]
  for (std::size_t v = 0; v < 4; ++v) fine[v] = refine(along[0][v], along[1][v], along[2][v]);
  std::array<std::array<Patch, 2>, 2> children;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      for (std::size_t u = 0; u < 3; ++u)
        for (std::size_t v = 0; v < 3; ++v) children[a][b].points[u][v] = fine[b + v][a + u];
  return children;
}

}  // namespace vox
