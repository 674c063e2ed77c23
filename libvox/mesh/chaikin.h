#pragma once

#include "libvox/core/types.h"

namespace vox {

// Points along the boundary of an extended surface, and beyond it. Everybody takes them from here:
// the same bits wherever they are needed. Source: DESIGN section 4; Chaikin 1974.

/// The point of an edge at a quarter of its length.
inline Vec3d chaikin(const Vec3d& near, const Vec3d& far) {
  return (3.0 * near + far) / 4.0;
}

inline Vec3d middle(const Vec3d& a, const Vec3d& b) {
  return (a + b) / 2.0;
}

/// The mirror image of a point, with `centre` half way.
inline Vec3d mirrored(const Vec3d& point, const Vec3d& centre) {
  return 2.0 * centre - point;
}

}  // namespace vox
