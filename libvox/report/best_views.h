#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/render/camera.h"

#include <vector>

namespace vox {

/// Views from which most of some voxels are seen.
/// @param wanted   the voxels to be seen, a part of all
/// @param all      voxels that hide each other
/// @param toWorld  linear
/// @return  the best view, then one from another side that shows most of the rest. If nothing can
///   be seen from outside: from above a corner
std::vector<View> bestViews(const openvdb::MaskTree& wanted, const openvdb::MaskTree& all,
                            const openvdb::math::Transform& toWorld, UpAxis up);

}  // namespace vox
