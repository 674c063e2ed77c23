#pragma once

#include "libvox/mesh/patch.h"

#include <cmath>

namespace vox {

/// Largest steps between neighbouring control points along u and v, in faces that exist. They
/// decide how deep vertices are subdivided.
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

}  // namespace vox
