#include "tests/reference.h"

#include "libvox/grid/openvdb.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vox::test {
namespace {

using Triangle = std::array<Vec3d, 3>;

double linf(const Vec3d& a, const Vec3d& b) {
  return std::max({std::abs(a.x() - b.x()), std::abs(a.y() - b.y()), std::abs(a.z() - b.z())});
}

std::vector<Vec3d> cornersOf(const PolygonMesh& mesh, Index f) {
  std::vector<Vec3d> corners;
  for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
  return corners;
}

/// The triangles of a face: of a quad along its shorter diagonal, of others a fan.
std::vector<Triangle> triangles(std::vector<Vec3d> p) {
  if (p.size() == 4 && linf(p[1], p[3]) < linf(p[0], p[2])) p = {p[1], p[2], p[3], p[0]};
  std::vector<Triangle> fan;
  for (std::size_t i = 2; i < p.size(); ++i) fan.push_back({p[0], p[i - 1], p[i]});
  return fan;
}

double longestEdge(const Triangle& t) {
  return std::max({linf(t[0], t[1]), linf(t[1], t[2]), linf(t[2], t[0])});
}

/// Corner of the given point and direction in another face: w->v for the edge v->w.
Index findTwin(const PolygonMesh& mesh, Index from, Index to) {
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (Index i = 0; i < mesh.faceSize(f); ++i)
      if (mesh.face(f)[i] == to && mesh.face(f)[(i + 1) % mesh.faceSize(f)] == from)
        return mesh.faceOffsets[f] + i;
  return kNone;
}

/// Corner arithmetic by search: face of a corner, next corner, and the twin of its edge.
struct Corners {
  const PolygonMesh& mesh;
  Index face(Index c) const {
    Index f = 0;
    while (mesh.faceOffsets[f + 1] <= c) ++f;
    return f;
  }
  Index next(Index c) const {
    const Index f = face(c);
    return c + 1 < mesh.faceOffsets[f + 1] ? c + 1 : mesh.faceOffsets[f];
  }
  Index previous(Index c) const {
    const Index f = face(c);
    return c > mesh.faceOffsets[f] ? c - 1 : mesh.faceOffsets[f + 1] - 1;
  }
  Index twin(Index c) const {
    return findTwin(mesh, mesh.faceVertices[c], mesh.faceVertices[next(c)]);
  }
};

void addVertexFaces(const Corners& corners, PolygonMesh& out) {
  for (Index c = 0; c < corners.mesh.cornerCount(); ++c) {
    std::vector<Index> ring = {c};
    Index k = corners.twin(corners.previous(c));
    for (; k != kNone && k != c; k = corners.twin(corners.previous(k))) ring.push_back(k);
    const bool first = *std::min_element(ring.begin(), ring.end()) == c;
    if (k == c && first && ring.size() >= 3) out.addFace(ring);
  }
}

/// Solid angle of a triangle seen from the origin, over 4 pi (van Oosterom & Strackee 1983).
double windingShare(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double top = a.dot(b.cross(c));
  const double bottom = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return std::atan2(top, bottom) / (2 * std::numbers::pi);
}

bool isInside(const std::vector<Triangle>& surface, const Vec3d& p) {
  double winding = 0;
  for (const Triangle& t : surface) winding += windingShare(t[0] - p, t[1] - p, t[2] - p);
  return winding > 0.5;
}

/// Whether the box of a triangle is within 1/2 (L-inf) of a point; so true for all triangles that
/// are.
bool isNear(const std::vector<Triangle>& surface, const Vec3d& p) {
  return std::any_of(surface.begin(), surface.end(), [&](const Triangle& t) {
    const Vec3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Vec3d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    return ((p - low).array() >= -0.5).all() && ((high - p).array() >= -0.5).all();
  });
}

/// Takes the 6-connected set of voxels around `from` out of `left`, a set of inactive voxels.
std::vector<openvdb::Coord> takeComponent(openvdb::MaskTree& left, const openvdb::Coord& from) {
  std::vector<openvdb::Coord> component = {from};
  left.setValueOff(from);
  for (std::size_t i = 0; i < component.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        openvdb::Coord next = component[i];
        next[axis] += step;
        if (!left.isValueOn(next)) continue;
        left.setValueOff(next);
        component.push_back(next);
      }
  return component;
}

}  // namespace

PolygonMesh naiveDooSabin(const PolygonMesh& mesh) {
  PolygonMesh out;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const std::vector<Vec3d> p = cornersOf(mesh, f);
    const int n = static_cast<int>(p.size());
    for (int i = 0; i < n; ++i) {
      Vec3d sum = Vec3d::Zero();
      for (int j = 0; j < n; ++j) {
        const double weight =
            i == j ? (n + 5.0) / (4 * n)
                   : (3 + 2 * std::cos(2 * std::numbers::pi * (i - j) / n)) / (4 * n);
        sum += weight * p[static_cast<std::size_t>(j)];
      }
      out.points.push_back(sum);
    }
  }
  const Corners corners{mesh};
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<Index> face;
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) face.push_back(c);
    out.addFace(face);
  }
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const Index t = corners.twin(c);
    if (t != kNone && c < t)
      out.addFace(std::vector<Index>{corners.next(c), c, corners.next(t), t});
  }
  addVertexFaces(corners, out);
  return out;
}

double naiveLargestSpan(const PolygonMesh& mesh) {
  double largest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const std::vector<Vec3d> p = cornersOf(mesh, f);
    double span = 0;
    if (p.size() == 4) {
      const double one = std::max(longestEdge({p[0], p[1], p[2]}), longestEdge({p[0], p[2], p[3]}));
      const double two = std::max(longestEdge({p[1], p[2], p[3]}), longestEdge({p[1], p[3], p[0]}));
      span = std::min(one, two);
    } else {
      for (const Vec3d& a : p)
        for (const Vec3d& b : p) span = std::max(span, linf(a, b));
    }
    largest = std::max(largest, span);
  }
  return largest;
}

Sides sidesOf(const PolygonMesh& closedMeshIndex, const openvdb::MaskGrid& mask) {
  std::vector<Triangle> surface;
  for (Index f = 0; f < closedMeshIndex.faceCount(); ++f)
    for (const Triangle& t : triangles(cornersOf(closedMeshIndex, f))) surface.push_back(t);

  openvdb::CoordBBox box = mask.evalActiveVoxelBoundingBox();
  box.expand(2);
  openvdb::MaskTree left;
  for (const openvdb::Coord& voxel : box)
    if (!mask.tree().isValueOn(voxel)) left.setValueOn(voxel);

  Sides sides;
  for (const openvdb::Coord& start : box) {
    if (!left.isValueOn(start)) continue;
    ++sides.components;
    std::size_t inside = 0;
    std::size_t outside = 0;
    for (const openvdb::Coord& voxel : takeComponent(left, start)) {
      const Vec3d centre(voxel.x(), voxel.y(), voxel.z());
      if (!isNear(surface, centre)) ++(isInside(surface, centre) ? inside : outside);
    }
    sides.inside += inside;
    sides.outside += outside;
    sides.leaks += inside > 0 && outside > 0;
  }
  return sides;
}

}  // namespace vox::test
