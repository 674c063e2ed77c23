// The images of a face from its mean and its first harmonic, so that a face of n corners costs
// O(n); then the sum of the images around each vertex.

#include "libvox/prepare/lift_system.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <utility>

namespace vox {
namespace {

constexpr Index kImagesPerTask = 1024;
constexpr Index kUnknownsPerTask = 4096;

}  // namespace

LiftSystem::LiftSystem(const PolygonMesh& mesh, std::vector<Index> vertices)
    : mesh_(mesh),
      vertices_(std::move(vertices)),
      positions_(mesh.pointCount(), Vec3d::Zero()),
      images_(mesh.cornerCount()) {
  collectRoots();
  collectCorners();
}

void LiftSystem::collectRoots() {
  Index largest = 0;
  for (Index f = 0; f < mesh_.faceCount(); ++f) largest = std::max(largest, mesh_.faceSize(f));
  rootOffsets_.assign(std::size_t{largest} + 1, kNone);
  for (Index f = 0; f < mesh_.faceCount(); ++f) {
    Index& offset = rootOffsets_[mesh_.faceSize(f)];
    if (offset != kNone) continue;
    offset = static_cast<Index>(roots_.size());
    const auto more = unitRoots(mesh_.faceSize(f));
    roots_.insert(roots_.end(), more.begin(), more.end());
  }
}

void LiftSystem::collectCorners() {
  std::vector<Index> rowOf(mesh_.pointCount(), kNone);
  for (Index row = 0; row < rows(); ++row) rowOf[vertices_[row]] = row;
  cornerOffsets_.assign(std::size_t{rows()} + 1, 0);
  for (const Index v : mesh_.faceVertices)
    if (rowOf[v] != kNone) ++cornerOffsets_[rowOf[v] + 1];
  for (Index row = 0; row < rows(); ++row) cornerOffsets_[row + 1] += cornerOffsets_[row];
  corners_.resize(cornerOffsets_.back());
  std::vector<Index> slot(cornerOffsets_.begin(), cornerOffsets_.end() - 1);
  for (Index c = 0; c < mesh_.cornerCount(); ++c) {
    const Index row = rowOf[mesh_.faceVertices[c]];
    if (row != kNone) corners_[slot[row]++] = c;
  }
}

/// U_i = V_i / 4 + 3/4 mean + 1/(2n) (A cos t_i + B sin t_i), t_i = 2 pi i / n.
void LiftSystem::imageOfFace(Index f, std::span<const Vec3d> positions) {
  const auto face = mesh_.face(f);
  const auto n = static_cast<Index>(face.size());
  const UnitRoot* roots = roots_.data() + rootOffsets_[n];
  Vec3d sum = positions[face[0]];
  Vec3d sumCosine = sum;
  Vec3d sumSine = Vec3d::Zero();
  for (Index i = 1; i < n; ++i) {
    const Vec3d& p = positions[face[i]];
    sum += p;
    sumCosine += roots[i].cosine * p;
    sumSine += roots[i].sine * p;
  }
  sum *= 0.75 / n;
  sumCosine *= 0.5 / n;
  sumSine *= 0.5 / n;
  Vec3d* images = images_.data() + mesh_.faceOffsets[f];
  for (Index i = 0; i < n; ++i)
    images[i] =
        0.25 * positions[face[i]] + sum + roots[i].cosine * sumCosine + roots[i].sine * sumSine;
}

Eigen::Matrix3Xd LiftSystem::sumCorners(std::span<const Vec3d> positions) {
  parallelForEach(mesh_.faceCount(), kImagesPerTask, [&](Index f) { imageOfFace(f, positions); });
  Eigen::Matrix3Xd sums(3, rows());
  parallelForEach(rows(), kUnknownsPerTask, [&](Index row) {
    Vec3d sum = images_[corners_[cornerOffsets_[row]]];
    for (Index k = cornerOffsets_[row] + 1; k < cornerOffsets_[row + 1]; ++k)
      sum += images_[corners_[k]];
    sums.col(row) = sum;
  });
  return sums;
}

Eigen::Matrix3Xd LiftSystem::multiply(const Eigen::Ref<const Eigen::Matrix3Xd>& x) {
  parallelForEach(rows(), kUnknownsPerTask,
                  [&](Index row) { positions_[vertices_[row]] = x.col(row); });
  return sumCorners(positions_);
}

}  // namespace vox
