// Patches at free boundaries: control points for missing faces.

#include "libvox/mesh/patch.h"

#include "libvox/mesh/chaikin.h"

namespace vox {

Patch continued(const Patch& partial) {
  Patch patch = partial;
  if (patch.quadrants == kAllQuadrants) return patch;
  auto& p = patch.points;
  const auto has = [&](unsigned quadrants) { return (partial.quadrants & quadrants) != 0; };
  if (!has(1U | 2U)) p[0][1] = mirrored(p[2][1], p[1][1]);
  if (!has(1U | 4U)) p[1][0] = mirrored(p[1][2], p[1][1]);
  if (!has(4U | 8U)) p[2][1] = mirrored(p[0][1], p[1][1]);
  if (!has(2U | 8U)) p[1][2] = mirrored(p[1][0], p[1][1]);
  for (unsigned q = 0; q < 4; ++q) {
    const std::size_t u = q & 2U;
    const std::size_t v = 2 * (q & 1U);
    if (!has(1U << q)) p[u][v] = p[u][1] + p[1][v] - p[1][1];
  }
  patch.quadrants = kAllQuadrants;
  return patch;
}

}  // namespace vox
