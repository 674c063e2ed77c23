#pragma once

#include "libvox/mesh/patch.h"

namespace vox {

/// Unit normal between two directions; 0 if they have none.
Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV);

/// A patch with all quadrants: what is missing of it goes on straight from the rest.
Patch completed(Patch patch);

}  // namespace vox
