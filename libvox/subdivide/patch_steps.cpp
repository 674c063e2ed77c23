// Steps between the control points of a patch.

#include "libvox/subdivide/patch_steps.h"

namespace vox {

PatchSteps::PatchSteps(const Patch& patch) {
  // The quadrants beside a step; it counts if one of them exists.
  constexpr unsigned kBesideU[2][3] = {{1, 3, 2}, {4, 12, 8}};
  constexpr unsigned kBesideV[2][3] = {{1, 5, 4}, {2, 10, 8}};
  const auto& p = patch.points;
  if (patch.quadrants == kAllQuadrants) {
    for (std::size_t b = 0; b < 3; ++b) {
      u = u.cwiseMax((p[1][b] - p[0][b]).cwiseAbs()).cwiseMax((p[2][b] - p[1][b]).cwiseAbs());
      v = v.cwiseMax((p[b][1] - p[b][0]).cwiseAbs()).cwiseMax((p[b][2] - p[b][1]).cwiseAbs());
    }
    return;
  }
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      if ((patch.quadrants & kBesideU[a][b]) != 0)
        u = u.cwiseMax((p[a + 1][b] - p[a][b]).cwiseAbs());
      if ((patch.quadrants & kBesideV[a][b]) != 0)
        v = v.cwiseMax((p[b][a + 1] - p[b][a]).cwiseAbs());
    }
}

}  // namespace vox
