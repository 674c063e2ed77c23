// Image vertices of a single face.
// D. Doo, M. Sabin, Behaviour of recursive division surfaces near extraordinary points, 1978.

#include "libvox/subdivide/face_images.h"

#include <algorithm>

namespace vox {
namespace {

void imagesByRoots(std::span<const Vec3d> v, std::span<const UnitRoot> roots,
                   std::span<Vec3d> images) {
  const auto n = static_cast<double>(v.size());
  Vec3d sum = Vec3d::Zero();
  Vec3d sumCosine = Vec3d::Zero();
  Vec3d sumSine = Vec3d::Zero();
  for (std::size_t i = 0; i < v.size(); ++i) {
    sum += v[i];
    sumCosine += roots[i].cosine * v[i];
    sumSine += roots[i].sine * v[i];
  }
  for (std::size_t i = 0; i < v.size(); ++i)
    images[i] = 0.25 * v[i] + (0.75 / n) * sum +
                (0.5 / n) * (roots[i].cosine * sumCosine + roots[i].sine * sumSine);
}

}  // namespace

void FaceImages::ofPolygon(std::span<const Vec3d> corners, std::span<Vec3d> images) {
  const std::size_t n = corners.size();
  if (n == 4) {
    const auto quad = quadImages(corners[0], corners[1], corners[2], corners[3]);
    std::copy(quad.begin(), quad.end(), images.begin());
    return;
  }
  if (roots_.size() != n) roots_ = unitRoots(static_cast<Index>(n));
  imagesByRoots(corners, roots_, images);
}

}  // namespace vox
