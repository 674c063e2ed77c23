// When a mesh is fine enough.

#include "libvox/subdivide/stop.h"

#include "libvox/core/parallel.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <array>

namespace vox {
namespace {

constexpr Index kCornersPerTask = 4096;

double distance(const Vec3d& a, const Vec3d& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

double quadSpan(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const double edges = std::max({distance(a, b), distance(b, c), distance(c, d), distance(d, a)});
  return std::max(edges, std::min(distance(a, c), distance(b, d)));
}

double faceFaceSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image, Index c) {
  const Index f = level.adjacency.cornerFace[c];
  if (level.mesh.faceOffsets[f] != c) return 0;
  return faceSpan({image.data() + c, level.mesh.faceSize(f)});
}

double edgeFaceSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image, Index c) {
  if (!leadsEdge(level.adjacency, c)) return 0;
  const Index t = level.adjacency.twin[c];
  return quadSpan(image[nextCorner(level.mesh, level.adjacency, c)], image[c],
                  image[nextCorner(level.mesh, level.adjacency, t)], image[t]);
}

double vertexFaceSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image, Index c,
                      std::vector<Vec3d>& ring) {
  if (ledRingSize(level.mesh, level.adjacency, c) < 3) return 0;
  ring.clear();
  Index k = c;
  do {
    ring.push_back(image[k]);
    k = nextAroundVertex(level.mesh, level.adjacency, k);
  } while (k != c);
  return faceSpan(ring);
}

/// Of the half E-face and the half V-face of boundary corner k.
double halfFaceSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image,
                    const std::vector<Index>& boundary, std::size_t k, std::vector<Vec3d>& ring) {
  const PolygonMesh& mesh = level.mesh;
  const Adjacency& adjacency = level.adjacency;
  const Index c = boundary[k];
  const Vec3d* const points = image.data() + mesh.cornerCount();
  ring.clear();
  Index last = c;
  for (Index x = c; x != kNone; x = nextAroundVertex(mesh, adjacency, x)) {
    ring.push_back(image[x]);
    last = x;
  }
  const Index arriving = previousCorner(mesh, adjacency, last);
  const auto j = std::lower_bound(boundary.begin(), boundary.end(), arriving) - boundary.begin();
  ring.push_back(points[2 * j + 1]);
  ring.push_back(points[2 * k]);
  return std::max(faceSpan(ring), quadSpan(image[nextCorner(mesh, adjacency, c)], image[c],
                                           points[2 * k], points[2 * k + 1]));
}

double largestHalfFaceSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image) {
  const std::vector<Index> boundary = boundaryCorners(level.adjacency);
  return maxOverParts(boundary.size(), kCornersPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3d> ring;
    double largest = 0;
    for (std::size_t k = begin; k != end; ++k)
      largest = std::max(largest, halfFaceSpan(level, image, boundary, k, ring));
    return largest;
  });
}

}  // namespace

double faceSpan(std::span<const Vec3d> corners) {
  if (corners.size() == 4) return quadSpan(corners[0], corners[1], corners[2], corners[3]);
  Vec3d low = corners[0];
  Vec3d high = corners[0];
  for (const Vec3d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return (high - low).maxCoeff();
}

double largestChildSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image) {
  const double half =
      level.boundary == BoundaryStage::kExtend ? largestHalfFaceSpan(level, image) : 0;
  const double whole = maxOverParts(
      level.mesh.cornerCount(), kCornersPerTask, [&](std::size_t begin, std::size_t end) {
        std::vector<Vec3d> ring;
        double largest = 0;
        for (Index c = static_cast<Index>(begin); c != end; ++c)
          largest = std::max({largest, faceFaceSpan(level, image, c), edgeFaceSpan(level, image, c),
                              vertexFaceSpan(level, image, c, ring)});
        return largest;
      });
  return std::max(half, whole);
}

}  // namespace vox
