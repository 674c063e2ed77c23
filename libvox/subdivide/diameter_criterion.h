#pragma once

#include "libvox/subdivide/criterion.h"

#include <memory>

namespace vox {

/// Largest L-inf diameter of the faces around an irregular vertex.
double largestDiameter(const VertexFaces& faces);

/// Criterion: the L-inf diameter of faces is at most `limit`. The faces k levels below a regular
/// vertex measure at most 2^-k (max |du| + max |dv|).
std::unique_ptr<Criterion> diameterCriterion(double limit);

}  // namespace vox
