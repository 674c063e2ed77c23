#pragma once

#include "libvox/core/types.h"
#include "libvox/core/unit_root.h"

#include <array>
#include <span>
#include <vector>

namespace vox {

/// Image vertex of the corner `at` of a quad, between `before` and `after`. Weights 9/16, 3/16,
/// 1/16, 3/16: exact in binary, and the same bits for either winding.
inline Vec3d quadImage(const Vec3d& at, const Vec3d& before, const Vec3d& after,
                       const Vec3d& opposite) {
  return (9.0 * at + 3.0 * (before + after) + opposite) / 16.0;
}

/// All four, in the order of the corners.
inline std::array<Vec3d, 4> quadImages(const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                       const Vec3d& d) {
  return {quadImage(a, b, d, c), quadImage(b, a, c, d), quadImage(c, b, d, a),
          quadImage(d, a, c, b)};
}

/// Image vertices of single faces; keeps the cosines of the last face size it met.
class FaceImages {
 public:
  /// One image per corner of a face of n >= 3 corners. With centroid m and first harmonic (A, B):
  /// U_i = V_i / 4 + 3/4 m + 1/(2n) (A cos t_i + B sin t_i),  t_i = 2 pi i / n. Cost O(n).
  /// Source: Doo & Sabin 1978; paper section 2.1, eq. (1).
  void of(std::span<const Vec3d> corners, std::span<Vec3d> images);

 private:
  std::vector<UnitRoot> roots_;
};

}  // namespace vox
