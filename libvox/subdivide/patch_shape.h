#pragma once

#include "libvox/core/types.h"

namespace vox {

/// Unit vector along alongU x alongV; 0 if the two are parallel or one of them is 0.
Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV);

}  // namespace vox
