#pragma once

#include "libvox/core/types.h"

namespace vox {

// Points on the boundary of an extended surface, and beyond it. All code uses these functions, so
// that a point has the same bits everywhere. Source: DESIGN section 4; Chaikin 1974.

/// The point on the edge from `near` to `far` at a quarter of its length.
inline Vec3d chaikin(const Vec3d& near, const Vec3d& far) {
  return (3.0 * near + far) / 4.0;
}

/// Midpoint of a and b.
inline Vec3d middle(const Vec3d& a, const Vec3d& b) {
  return (a + b) / 2.0;
}

/// Mirror image of `point`: `centre` is the midpoint of both.
inline Vec3d mirrored(const Vec3d& point, const Vec3d& centre) {
  return 2.0 * centre - point;
}

}  // namespace vox
