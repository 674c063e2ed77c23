#pragma once

#include "libvox/subdivide/criterion.h"

#include <memory>

namespace vox {

/// Polygons within `limit` of the surface. With second differences Duu, Dvv and twists Duv of the
/// control points, the faces of a regular vertex, cut along a diagonal, and the surface differ by
/// at most (4^-u |Duu| + 4^-v |Dvv|) / 8 + 2^-(u+v) |Duv| / 4 where they have the same parameters.
/// Of that, only what points along the normal is distance, as far as the normal is one: tangential
/// parts count by the sine of the angle between the patch's mean normal and the farthest of its
/// faces.
std::unique_ptr<Criterion> flatnessCriterion(double limit);

}  // namespace vox
