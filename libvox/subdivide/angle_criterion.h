#pragma once

#include "libvox/subdivide/criterion.h"

#include <memory>

namespace vox {

/// At most `limit` degrees between the normals of neighbours, measured between all faces around the
/// descendants. Faces that fit into a voxel may turn as they like, so that folds come to an end.
std::unique_ptr<Criterion> angleCriterion(double limit);

}  // namespace vox
