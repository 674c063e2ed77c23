#pragma once

#include "libvox/mesh/patch.h"

#include <cmath>
#include <limits>

namespace vox {

struct VertexSplit;

// Measures that decide how deep vertices are subdivided. They are computed on the vector unit, with
// the same bits on every processor.

/// Largest steps between neighbouring control points along u and v, in faces that exist.
struct PatchSteps {
  Vec3d u = Vec3d::Zero();
  Vec3d v = Vec3d::Zero();
  explicit PatchSteps(const Patch& patch);
  /// Upper bound of the L-inf diameter of the faces that are `alongU` levels below along u and
  /// `alongV` levels below along v.
  double sizeBelow(int alongU, int alongV) const {
    return (u * std::ldexp(1.0, -alongU) + v * std::ldexp(1.0, -alongV)).maxCoeff();
  }
};

/// Sizes of the faces around the four children of a vertex (L-inf). A child is fine enough if its
/// size is at most kVertexConversionSpan.
struct ChildSizes {
  double f, vFace;  ///< of the children in F and the V-face: the largest diameter of the quads
                    ///< around; if F or the V-face is no quad, its F-face comes on top
  double r, l;      ///< of the children in R and L: PatchSteps::sizeBelow(0, 0) of their patches
};

/// Stands for sizes that are not known: no child counts as fine enough.
inline constexpr double kUnknownSize = std::numeric_limits<double>::infinity();
inline constexpr ChildSizes kUnknownSizes = {kUnknownSize, kUnknownSize, kUnknownSize,
                                             kUnknownSize};

/// Sizes around the children of a vertex.
/// Precondition: R, L and the V-face exist.
ChildSizes childSizes(const VertexSplit& split);

}  // namespace vox
