// Triangles to cells, with the normals that tell the side of a point at edges and vertices:
// Baerentzen & Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005.

#include "libvox/foot/triangle_maker.h"

#include "libvox/core/parallel.h"
#include "libvox/foot/triangle_prism.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace vox {
namespace {

constexpr float kMargin = 0.02F;  // voxels

/// A corner and its edge to the next one, by the ends of the edge.
struct EdgeOfCorner {
  Index low, high, corner;
  auto key() const { return std::make_tuple(low, high, corner); }
};

}  // namespace

TriangleMaker::TriangleMaker(const PolygonMesh& mesh, float reach)
    : mesh_(mesh),
      reach_(reach),
      normals_(mesh.faceCount(), Vec3d::Zero()),
      vertexNormals_(mesh.points.size(), Vec3d::Zero()),
      edgeNormals_(mesh.cornerCount(), Vec3d::Zero()),
      turns_(mesh.points.size(), 0) {
  std::vector<EdgeOfCorner> edges;
  edges.reserve(mesh.cornerCount());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    const auto point = [&](std::size_t i) -> const Vec3d& { return mesh.points[face[i % 3]]; };
    const Vec3d area = (point(1) - point(0)).cross(point(2) - point(0));
    if (!(area.squaredNorm() > 0)) continue;
    normals_[f] = area.stableNormalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d a = point(i + 1) - point(i);
      const Vec3d b = point(i + 2) - point(i);
      vertexNormals_[face[i]] += std::atan2(a.cross(b).norm(), a.dot(b)) * normals_[f];
      const Index v = face[i];
      const Index w = face[(i + 1) % 3];
      edges.push_back(
          {std::min(v, w), std::max(v, w), mesh.faceOffsets[f] + static_cast<Index>(i)});
    }
  }
  parallelSort(edges,
               [](const EdgeOfCorner& a, const EdgeOfCorner& b) { return a.key() < b.key(); });
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    Vec3d sum = Vec3d::Zero();
    for (; end < edges.size() && edges[end].low == edges[begin].low &&
           edges[end].high == edges[begin].high;
         ++end)
      sum += normals_[edges[end].corner / 3];
    for (std::size_t i = begin; i < end; ++i) edgeNormals_[edges[i].corner] = sum;
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (const Index v : mesh.face(f)) {
      // To the mean normal and on to another one: at most twice the turn.
      const Vec3d mean = vertexNormals_[v].stableNormalized();
      const double sine = normals_[f].cross(mean).norm();
      const double turn = normals_[f].dot(mean) > 0.7 ? 2 * sine : 1;
      turns_[v] = std::max(turns_[v], std::min(1.0, turn));
    }
}

void TriangleMaker::add(Index begin, Index end, std::uint32_t firstOwner, CellStore& store) const {
  for (Index f = begin; f != end; ++f)
    if (!normals_[f].isZero(0)) addTriangle(f, firstOwner + f, store);
}

void TriangleMaker::addTriangle(Index f, std::uint32_t owner, CellStore& store) const {
  const auto face = mesh_.face(f);
  const auto& points = mesh_.points;
  const openvdb::Coord at = openvdb::Coord::round(openvdb::Vec3d(points[face[0]].data()));
  const Vec3d origin(at.x(), at.y(), at.z());
  std::array<Vec3d, 3> p;
  double turn = 0;
  bool open = false;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = points[face[i]] - origin;
    turn = std::max(turn, turns_[face[i]]);
    // An edge of one triangle: what lies beyond it is nearest to it.
    const Vec3d& sum = edgeNormals_[mesh_.faceOffsets[f] + static_cast<Index>(i)];
    open |= sum.squaredNorm() < 1.5;
  }
  const double reach = double{reach_};
  const double beyond = (open ? 1.0 : turn) * reach + double{kMargin};
  const Vec3d& n = normals_[f];
  const Prism prism =
      prismAround(p, at, TriangleFrame(p, n), {beyond, beyond, reach + double{kMargin}});
  if (prism.box.empty()) return;
  const auto added = store.triangles.emplace_back();
  TriangleCell& cell = *added;
  cell.prism = prism;
  cell.normal = asFloats(n);
  for (std::size_t i = 0; i < 3; ++i) {
    cell.points[i] = asFloats(p[i]);
    cell.edgeNormals[i] = asFloats(edgeNormals_[mesh_.faceOffsets[f] + static_cast<Index>(i)]);
    cell.vertexNormals[i] = asFloats(vertexNormals_[face[i]]);
  }
  store.bin(prism, owner, added - store.triangles.begin(), CellKind::kTriangle);
}

}  // namespace vox
