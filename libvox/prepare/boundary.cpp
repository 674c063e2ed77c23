// Boundary interpolation: the cyclic system 1/8, 3/4, 1/8 as a pair of recursive filters.
// With z the shift along the loop, (z + 6 + 1/z) / 8 = (1 - r z) (1 - r / z) / (-8 r), where r is
// the root of r^2 + 6 r + 1 = 0 inside the unit circle.

#include "libvox/prepare/boundary.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

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

/// The points of a mesh, moved loop by loop.
class Controls {
 public:
  Controls(const PolygonMesh& mesh, const CreaseCut& cut)
      : mesh_(mesh), cut_(cut), points_(mesh.points), controlAt_(cut.pointOrigin.size(), kNone) {}

  /// @param loop  boundary corners
  void solve(std::span<const Index> loop) {
    const std::size_t n = loop.size();
    const auto vertex = [&](std::size_t i) { return mesh_.faceVertices[loop[i % n]]; };
    const auto isCorner = [&](std::size_t i) {
      return hasNoLength(loop[i % n]) || hasNoLength(loop[(i + n - 1) % n]);
    };
    std::size_t first = 0;
    while (first < n && !isCorner(first)) ++first;
    run_.clear();
    if (first == n) {
      for (std::size_t i = 0; i < n; ++i) run_.push_back(vertex(i));
      move(interpolatingControls(pointsOfRun()));
      return;
    }
    Index start = vertex(first);
    for (std::size_t i = first + 1; i <= first + n; ++i) {
      const Index v = vertex(i);
      if (!isCorner(i)) {
        run_.push_back(v);
        continue;
      }
      move(interpolatingControls(mesh_.points[start], pointsOfRun(), mesh_.points[v]));
      run_.clear();
      start = v;
    }
  }

  std::vector<Vec3d> take() { return std::move(points_); }

 private:
  bool hasNoLength(Index edge) const { return !cut_.seam.empty() && cut_.seam[edge] == edge; }

  std::vector<Vec3d> pointsOfRun() const {
    std::vector<Vec3d> points;
    for (const Index v : run_) points.push_back(mesh_.points[v]);
    return points;
  }

  /// Moves the vertices of the run. A copy goes where the first copy of its vertex went.
  void move(const std::vector<Vec3d>& controls) {
    for (std::size_t i = 0; i < run_.size(); ++i) {
      const Index v = run_[i];
      points_[v] = controls[i];
      if (cut_.pointOrigin.empty()) continue;
      const Index origin = cut_.pointOrigin[v];
      if (controlAt_[origin] == kNone) controlAt_[origin] = v;
      points_[v] = points_[controlAt_[origin]];
    }
  }

  const PolygonMesh& mesh_;
  const CreaseCut& cut_;
  std::vector<Vec3d> points_;
  std::vector<Index> controlAt_;  ///< per vertex before the cut: its first moved copy, or kNone
  std::vector<Index> run_;        ///< vertices of a closed curve, or between two corners
};

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

std::vector<Vec3d> interpolatingControls(const Vec3d& start, std::span<const Vec3d> points,
                                         const Vec3d& end) {
  // The sum of each row of the matrix is 1, and it is diagonally dominant: no pivots are needed.
  constexpr double kSide = 1.0 / 8;
  constexpr double kMiddle = 3.0 / 4;
  std::vector<Vec3d> controls(points.begin(), points.end());
  std::vector<double> above(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double pivot = kMiddle - (i == 0 ? 0 : kSide * above[i - 1]);
    const Vec3d& before = i == 0 ? start : controls[i - 1];
    Vec3d rest = points[i] - kSide * before;
    if (i + 1 == points.size()) rest -= kSide * end;
    controls[i] = rest / pivot;
    above[i] = kSide / pivot;
  }
  for (std::size_t i = points.size(); i-- > 1;) controls[i - 1] -= above[i - 1] * controls[i];
  return controls;
}

PolygonMesh interpolateBoundary(PolygonMesh mesh, const Adjacency& adjacency,
                                const CreaseCut& cut) {
  Controls controls(mesh, cut);
  std::vector<bool> met(mesh.pointCount(), false);
  for (const std::vector<Index>& loop : boundaryLoops(mesh, adjacency)) {
    for (const Index c : loop) {
      const Index v = mesh.faceVertices[c];
      if (met[v])
        throw MeshError("vertex " + std::to_string(v) +
                        " is on the boundary more than once, so the boundary cannot be "
                        "interpolated; split the vertex");
      met[v] = true;
    }
    controls.solve(loop);
  }
  mesh.points = controls.take();
  return mesh;
}

}  // namespace vox
