// Points of patches; patches at free boundaries: control points for missing faces.

#include "libvox/mesh/patch.h"

#include "libvox/mesh/chaikin.h"

namespace vox {

SplinePoint splinePoint(const std::array<std::array<Vec3d, 3>, 3>& controls, SplinePlace u,
                        SplinePlace v) {
  CurvePoints values, slopes;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vec3d &a = controls[0][j], &b = controls[1][j], &c = controls[2][j];
    values[j] = u.value(a, b, c);
    slopes[j] = u.slope(a, b, c);
  }
  return {v.value(values[0], values[1], values[2]),
          normalOfTangents(v.value(slopes[0], slopes[1], slopes[2]),
                           v.slope(values[0], values[1], values[2]))};
}

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
