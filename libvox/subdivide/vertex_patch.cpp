// The patch around a vertex of a level.

#include "libvox/subdivide/vertex_patch.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vox {
namespace {

/// The values of a quad, from one of its corners on. If two of them are on the boundary of an
/// extended surface, they are replaced by the mirror images of the other two about them.
std::array<Vec3d, 4> quadFrom(const SubdivisionLevel& level, Index corner,
                              std::span<const Vec3d> values) {
  std::array<Vec3d, 4> points;
  std::array<Index, 4> corners;
  Index c = corner;
  for (std::size_t i = 0; i < 4; ++i, c = nextCorner(level.mesh, level.adjacency, c)) {
    corners[i] = c;
    points[i] = values[level.mesh.faceVertices[c]];
  }
  if (level.boundary != BoundaryStage::kStrips) return points;
  for (std::size_t i = 0; i < 4; ++i) {
    if (level.adjacency.twin[corners[i]] != kNone) continue;
    const std::size_t start = i;
    const std::size_t end = (i + 1) % 4;
    points[start] = mirrored(points[(start + 3) % 4], points[start]);
    points[end] = mirrored(points[(end + 1) % 4], points[end]);
  }
  return points;
}

}  // namespace

std::optional<Patch> patchAround(const SubdivisionLevel& level, const OneRing& ring,
                                 std::span<const Vec3d> values) {
  if (ring.closed ? ring.corners.size() != 4 : ring.corners.size() > 3) return {};
  for (const Index c : ring.corners)
    if (level.mesh.faceSize(level.adjacency.cornerFace[c]) != 4) return {};
  // Quadrants in counter-clockwise order, and the steps to the next vertex along each face.
  constexpr std::array<std::array<int, 2>, 4> kAlong = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  constexpr std::array<unsigned, 4> kQuadrant = {3, 1, 0, 2};
  Patch patch;
  for (auto& row : patch.points) row.fill(values[level.mesh.faceVertices[ring.corners[0]]]);
  unsigned quadrants = 0;
  for (std::size_t k = 0; k < ring.corners.size(); ++k) {
    const auto& a = kAlong[k];
    const auto& b = kAlong[(k + 1) % 4];
    const auto put = [&](int u, int v, const Vec3d& p) {
      patch.points[static_cast<std::size_t>(u + 1)][static_cast<std::size_t>(v + 1)] = p;
    };
    const auto face = quadFrom(level, ring.corners[k], values);
    put(a[0], a[1], face[1]);
    put(a[0] + b[0], a[1] + b[1], face[2]);
    put(b[0], b[1], face[3]);
    quadrants |= 1U << kQuadrant[k];
  }
  patch.quadrants = static_cast<std::uint8_t>(quadrants);
  return patch;
}

double largestFace(const PolygonMesh& mesh, const Adjacency& adjacency, const OneRing& ring) {
  double largest = 0;
  std::vector<Vec3d> points;
  for (const Index c : ring.corners) {
    points.clear();
    for (const Index v : mesh.face(adjacency.cornerFace[c])) points.push_back(mesh.points[v]);
    largest = std::max(largest, diameter(points));
  }
  return largest;
}

}  // namespace vox
