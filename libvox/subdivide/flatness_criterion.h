#pragma once

#include "libvox/subdivide/criterion.h"

#include <memory>

namespace vox {

/// Criterion: polygons are within `limit` of the surface. Let Duu and Dvv be second differences of
/// the control points of a patch, and Duv their twists. At depths u and v, a face, cut along a
/// diagonal, and the surface differ at equal parameters by at most
/// (4^-u |Duu| + 4^-v |Dvv|) / 8 + 2^-(u+v) |Duv| / 4. Only the part of it along the mean normal of
/// the patch counts in full. The tangential part counts times the sine of the largest angle between
/// the mean normal and the normal of a face.
std::unique_ptr<Criterion> flatnessCriterion(double limit);

}  // namespace vox
