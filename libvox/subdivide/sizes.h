#pragma once

#include "libvox/mesh/patch.h"

#include <cmath>
#include <limits>

namespace vox {

struct VertexSplit;

// What decides how deep vertices go, measured on the vector unit: the same bits on every processor.

/// Largest steps along u and v over the faces of a patch that exist.
struct PatchSteps {
  Vec3d u = Vec3d::Zero();
  Vec3d v = Vec3d::Zero();
  explicit PatchSteps(const Patch& patch);
  /// Bound of the L-inf diameter of the faces some levels below.
  double sizeBelow(int alongU, int alongV) const {
    return (u * std::ldexp(1.0, -alongU) + v * std::ldexp(1.0, -alongV)).maxCoeff();
  }
};

/// Sizes around the children of a vertex. A child is fine enough when what is said of it is at most
/// kVertexConversionSpan.
struct ChildSizes {
  double f, vFace;  ///< in F and the V-face: the largest diameter of the quads around; F and the
                    ///< V-face if they are no quads have children of their own besides
  double r, l;      ///< in R and L: PatchSteps::sizeBelow(0, 0) of childInR and childInL
};

/// Of a vertex about which nothing is known, none of its children is fine enough.
inline constexpr double kUnknownSize = std::numeric_limits<double>::infinity();
inline constexpr ChildSizes kUnknownSizes = {kUnknownSize, kUnknownSize, kUnknownSize,
                                             kUnknownSize};

/// For a vertex that has R, L and its V-face.
ChildSizes childSizes(const VertexSplit& split);

}  // namespace vox
