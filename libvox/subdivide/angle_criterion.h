#pragma once

#include "libvox/subdivide/criterion.h"

#include <memory>

namespace vox {

/// Criterion: the normals of neighbouring faces around all descendants differ by at most `limit`
/// degrees. Faces that fit into a voxel meet it in any case, so that subdivision ends at folds.
std::unique_ptr<Criterion> angleCriterion(double limit);

}  // namespace vox
