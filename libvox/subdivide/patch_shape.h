#pragma once

#include "libvox/core/types.h"

namespace vox {

/// Unit normal between two directions; 0 if they have none.
Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV);

}  // namespace vox
