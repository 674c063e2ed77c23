#pragma once

#include "libvox/core/types.h"
#include "libvox/subdivide/level.h"

#include <vector>

namespace vox {

// What is given at the corners of a face is blended in the square of each corner
// (mesh/limit_piece.h) bilinearly between the mean of the face, the middles of two edges and the
// corner. So the value of a face never reaches into another one. Source: DESIGN section 12.

/// The bilinear function of the square of a corner, from the values at its four corners.
template <class T>
struct CornerBlend {
  T corner, next, previous, mean;  // at (0, 0), (1, 0), (0, 1), (1, 1)

  T at(double u, double v) const {
    using Scalar = typename T::Scalar;
    const auto s = static_cast<Scalar>(u);
    const auto t = static_cast<Scalar>(v);
    return (s * t) * mean + (s * (1 - t)) * next + ((1 - s) * t) * previous +
           ((1 - s) * (1 - t)) * corner;
  }
  T alongU(double v) const {
    const auto t = static_cast<typename T::Scalar>(v);
    return t * (mean - previous) + (1 - t) * (next - corner);
  }
  T alongV(double u) const {
    const auto s = static_cast<typename T::Scalar>(u);
    return s * (mean - next) + (1 - s) * (previous - corner);
  }
};

/// @param mean     of the face of the corner
/// @param valueAt  the value of a corner
template <class T, class ValueAt>
CornerBlend<T> blendOf(const SubdivisionLevel& base, Index corner, const T& mean,
                       ValueAt&& valueAt) {
  const T here = valueAt(corner);
  const T next = valueAt(nextCorner(base.mesh, base.adjacency, corner));
  const T previous = valueAt(previousCorner(base.mesh, base.adjacency, corner));
  return {here, (here + next) / 2, (here + previous) / 2, mean};
}

/// The mean of the values at the corners of each face.
template <class T, class ValueAt>
std::vector<T> meansOfFaces(const PolygonMesh& mesh, ValueAt&& valueAt) {
  std::vector<T> means;
  means.reserve(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    Eigen::Matrix<double, T::RowsAtCompileTime, 1> sum;
    sum.setZero();
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c)
      sum += valueAt(c).template cast<double>();
    means.emplace_back((sum / mesh.faceSize(f)).template cast<typename T::Scalar>());
  }
  return means;
}

/// The colours of a mesh at its corners; none if it has none. Those of points win.
std::vector<Vec3f> colorsOfCorners(const PolygonMesh& mesh);

}  // namespace vox
