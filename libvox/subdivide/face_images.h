#pragma once

#include "libvox/core/types.h"
#include "libvox/core/unit_root.h"

#include <array>
#include <span>
#include <vector>

namespace vox {

/// Image vertex of the corner `at` of a quad, whose neighbours are `before` and `after`. Weights
/// 9/16, 3/16, 1/16, 3/16: exact in binary. Both windings give the same bits.
inline Vec3d quadImage(const Vec3d& at, const Vec3d& before, const Vec3d& after,
                       const Vec3d& opposite) {
  return (9.0 * at + 3.0 * (before + after) + opposite) / 16.0;
}

/// Image vertices of all four corners of a quad, in their order.
inline std::array<Vec3d, 4> quadImages(const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                       const Vec3d& d) {
  return {quadImage(a, b, d, c), quadImage(b, a, c, d), quadImage(c, b, d, a),
          quadImage(d, a, c, b)};
}

/// The mean of a triangle, halved: what each of its image vertices adds to half of its corner.
inline Vec3d halfMean(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return (a + b + c) / 6.0;
}

/// Image vertices of single faces. Keeps the cosines for the last face size. One object per thread.
class FaceImages {
 public:
  /// Image vertices of a face with n >= 3 corners, one per corner. With centroid m and first
  /// harmonic (A, B): U_i = V_i / 4 + 3/4 m + 1/(2n) (A cos t_i + B sin t_i), t_i = 2 pi i / n.
  /// Cost O(n).
  /// Source: Doo & Sabin 1978; paper section 2.1, eq. (1).
  void of(std::span<const Vec3d> corners, std::span<Vec3d> images) {
    if (corners.size() == 3) {  // weights 2/3, 1/6, 1/6
      const Vec3d sixth = halfMean(corners[0], corners[1], corners[2]);
      for (std::size_t i = 0; i < 3; ++i) images[i] = 0.5 * corners[i] + sixth;
    } else {
      ofPolygon(corners, images);
    }
  }

 private:
  void ofPolygon(std::span<const Vec3d> corners, std::span<Vec3d> images);

  std::vector<UnitRoot> roots_;
};

}  // namespace vox
