// Boundary interpolation: the cyclic system 1/8, 3/4, 1/8 as a pair of recursive filters.
// With z the shift along the loop, (z + 6 + 1/z) / 8 = (1 - r z) (1 - r / z) / (-8 r), where r is
// the root of r^2 + 6 r + 1 = 0 inside the unit circle.

#include "libvox/prepare/boundary.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vox {
namespace {

/// Replaces `values` by the x with x[i] = values[i] + r x[i-1], cyclically. x[0] is a geometric
/// series around the loop; terms below rounding are left out.
void filterCyclically(std::vector<Vec3d>& values, double r) {
  constexpr double kNegligible = 1e-40;
  const std::size_t n = values.size();
  if (n == 0) return;
  Vec3d first = Vec3d::Zero();
  double power = 1;
  for (std::size_t j = 0; j < n; ++j) {
    if (std::abs(power) < kNegligible) break;
    first += power * values[(n - j) % n];
    power *= r;
  }
  values[0] = first / (1 - power);
  for (std::size_t i = 1; i < n; ++i) values[i] += r * values[i - 1];
}

}  // namespace

std::vector<Vec3d> interpolatingControls(std::span<const Vec3d> points) {
  const double r = 2 * std::sqrt(2.0) - 3;
  const std::size_t n = points.size();
  // The unknowns are the differences between controls and points: small numbers, even if the model
  // is far from the origin.
  std::vector<Vec3d> moves(n);
  for (std::size_t i = 0; i < n; ++i)
    moves[i] = ((points[i] - points[(i + n - 1) % n]) + (points[i] - points[(i + 1) % n])) / 8.0;
  filterCyclically(moves, r);
  std::reverse(moves.begin(), moves.end());
  filterCyclically(moves, r);
  std::reverse(moves.begin(), moves.end());
  for (std::size_t i = 0; i < n; ++i) moves[i] = points[i] - 8 * r * moves[i];
  return moves;
}

PolygonMesh interpolateBoundary(PolygonMesh mesh, const Adjacency& adjacency) {
  std::vector<bool> moved(mesh.pointCount(), false);
  std::vector<Vec3d> points;
  for (const std::vector<Index>& loop : boundaryLoops(mesh, adjacency)) {
    points.clear();
    for (const Index c : loop) {
      const Index v = mesh.faceVertices[c];
      if (moved[v])
        throw MeshError("vertex " + std::to_string(v) +
                        " is on the boundary more than once, so the boundary cannot be "
                        "interpolated; split the vertex");
      moved[v] = true;
      points.push_back(mesh.points[v]);
    }
    const std::vector<Vec3d> controls = interpolatingControls(points);
    for (std::size_t i = 0; i < loop.size(); ++i)
      mesh.points[mesh.faceVertices[loop[i]]] = controls[i];
  }
  return mesh;
}

}  // namespace vox
