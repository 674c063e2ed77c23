// Volume by the divergence theorem. Inside or outside by the parity of crossings of a ray, with
// half-open edges.

#include "libvox/prepare/enclosure.h"

#include "libvox/core/parallel.h"

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace vox {
namespace {

/// Calls visit(a, b, c) for the triangles of a face, as a fan from its first corner.
template <class Visit>
void forEachTriangle(const PolygonMesh& mesh, Index f, Visit&& visit) {
  const auto face = mesh.face(f);
  for (std::size_t i = 1; i + 1 < face.size(); ++i)
    visit(mesh.points[face[0]], mesh.points[face[i]], mesh.points[face[i + 1]]);
}

/// Whether, in the projection along x, the ray from p in +z crosses edge ab. The interval of y of
/// the edge is half open. ab and ba give the same answer.
bool crossesAbove(Vec3d a, Vec3d b, const Vec3d& p) {
  if ((a.y() > p.y()) == (b.y() > p.y())) return false;
  if (a.y() > b.y()) std::swap(a, b);
  const double across = (b.y() - a.y()) * (p.z() - a.z()) - (p.y() - a.y()) * (b.z() - a.z());
  return across < 0;
}

/// Whether the ray from p in +x meets the triangle.
bool rayMeets(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  if (!(crossesAbove(a, b, p) ^ crossesAbove(b, c, p) ^ crossesAbove(c, a, p))) return false;
  const Vec3d normal = (b - a).cross(Vec3d(c - a));
  const double toPlane = normal.dot(Vec3d(a - p));
  return normal.x() > 0 ? toPlane > 0 : toPlane < 0;
}

}  // namespace

SignedVolume signedVolume(const PolygonMesh& mesh, std::span<const Index> faces) {
  if (faces.empty()) return {};
  const Vec3d origin = mesh.points[mesh.face(faces[0])[0]];
  const auto sumOf = [&](std::size_t begin, std::size_t end) {
    SignedVolume sum;
    for (const Index f : faces.subspan(begin, end - begin))
      forEachTriangle(mesh, f, [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const double six = (a - origin).dot(Vec3d(b - origin).cross(Vec3d(c - origin)));
        sum.volume += six / 6;
        sum.scale += std::abs(six) / 6;
      });
    return sum;
  };
  return parallelSum(faces.size(), kElementsPerTask, SignedVolume{}, sumOf);
}

bool encloses(const PolygonMesh& mesh, std::span<const Index> faces, const Vec3d& point) {
  bool inside = false;
  for (const Index f : faces)
    forEachTriangle(mesh, f, [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
      inside ^= rayMeets(a, b, c, point);
    });
  return inside;
}

}  // namespace vox
