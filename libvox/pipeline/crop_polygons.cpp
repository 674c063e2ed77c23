// Clipping of polygons by the planes of a box: Sutherland and Hodgman, Reentrant polygon clipping,
// Communications of the ACM 17 (1974).

#include "libvox/pipeline/crop_polygons.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace vox {
namespace {

using Polygon = std::vector<Vec3d>;

/// Half of space beside a plane across an axis: above it (side 1) or below (side -1).
struct HalfSpace {
  int axis;
  double side, at;

  double depthOf(const Vec3d& p) const { return side * (p[axis] - at); }
};

/// The part of a convex polygon in a half space.
Polygon clipped(const Polygon& polygon, const HalfSpace& half) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d& a = polygon[i];
    const Vec3d& b = polygon[(i + 1) % polygon.size()];
    const double da = half.depthOf(a);
    const double db = half.depthOf(b);
    if (da >= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.emplace_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

/// The part of a polygon between the planes of a box across an axis.
Polygon between(const Box& box, int axis, const Polygon& polygon) {
  return clipped(clipped(polygon, {axis, 1, box.low[axis]}), {axis, -1, box.high[axis]});
}

template <class Visit>
void forEachTriangle(const PolygonMesh& mesh, Visit&& visit) {
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      visit(Polygon{mesh.points[face[0]], mesh.points[face[i]], mesh.points[face[i + 1]]});
  }
}

/// The integral of z - floor over the shadow of a polygon on the xy plane, and its signed area.
struct Shadow {
  double area = 0, volume = 0;
};
Shadow shadowOf(const Polygon& polygon, double floor) {
  Shadow all;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec3d& a = polygon[0];
    const Vec3d& b = polygon[i];
    const Vec3d& c = polygon[i + 1];
    const double area = (b - a).cross(c - a).z() / 2;
    all.area += area;
    all.volume += area * ((a.z() + b.z() + c.z()) / 3 - floor);
  }
  return all;
}

}  // namespace

PolygonMesh croppedTo(const Box& box, const PolygonMesh& mesh) {
  PolygonMesh part;
  std::vector<Index> face;
  forEachTriangle(mesh, [&](const Polygon& triangle) {
    const Polygon polygon = between(box, 2, between(box, 1, between(box, 0, triangle)));
    if (polygon.size() < 3) return;
    face.clear();
    for (const Vec3d& point : polygon) {
      face.push_back(static_cast<Index>(part.points.size()));
      part.points.push_back(point);
    }
    part.addFace(face);
  });
  return part;
}

double volumeWithin(const Box& box, const PolygonMesh& mesh) {
  const double floor = box.low.z();
  const double height = box.high.z() - floor;
  double volume = 0;
  forEachTriangle(mesh, [&](const Polygon& triangle) {
    const Polygon column = between(box, 1, between(box, 0, triangle));
    volume += shadowOf(between(box, 2, column), floor).volume +
              height * shadowOf(clipped(column, {2, 1, box.high.z()}), floor).area;
  });
  return volume;
}

}  // namespace vox
