// Equal points are found by sorting; near points by a grid of cells as wide as the tolerance. The
// points that stay are further apart than the tolerance, so a cell holds only a few of them.

#include "libvox/prepare/weld.h"

#include "libvox/core/error.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace vox {
namespace {

std::vector<Index> weldEqual(const std::vector<Vec3d>& points, const std::vector<bool>& used) {
  std::vector<Index> order;
  for (Index v = 0; v < points.size(); ++v)
    if (used[v]) order.push_back(v);
  const auto before = [&](Index a, Index b) {
    const Vec3d& p = points[a];
    const Vec3d& q = points[b];
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != q[axis]) return p[axis] < q[axis];
    return a < b;
  };
  parallelSort(order, before);

  std::vector<Index> target = numbered(points.size());
  for (std::size_t k = 1; k < order.size(); ++k)
    if (points[order[k]] == points[order[k - 1]]) target[order[k]] = target[order[k - 1]];
  return target;
}

/// Coordinates of a cell: integers, stored as doubles so that none overflows.
using Cell = std::array<double, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::size_t h = 0;
    for (const double x : cell)
      h = (h ^ std::hash<double>{}(x)) * 0x9e3779b97f4a7c15ULL ^ (h >> 29);
    return h;
  }
};

/// The points that have stayed so far, by cell.
class NearPoints {
 public:
  NearPoints(const std::vector<Vec3d>& points, double tolerance)
      : points_(points), tolerance_(tolerance) {
    double largest = 0;
    for (const Vec3d& p : points) largest = std::max(largest, p.lpNorm<Eigen::Infinity>());
    cellSize_ = std::max(tolerance, largest * 1e-290);  // the quotient stays finite
  }

  /// The lowest-numbered of these points within the tolerance of v, or kNone.
  Index nearest(Index v) const {
    const Cell centre = cellOf(v);
    Index lowest = kNone;
    for (int k = 0; k < 27; ++k) {
      const auto found = cells_.find({centre[0] + k / 9 - 1, centre[1] + k / 3 % 3 - 1,  //
                                      centre[2] + k % 3 - 1});
      if (found == cells_.end()) continue;
      for (const Index w : found->second)
        if (w < lowest && (points_[w] - points_[v]).stableNorm() <= tolerance_) lowest = w;
    }
    return lowest;
  }

  void add(Index v) { cells_[cellOf(v)].push_back(v); }

 private:
  Cell cellOf(Index v) const {
    const Vec3d& p = points_[v];
    // + 0 turns -0 into +0: std::hash distinguishes them.
    return {std::floor(p.x() / cellSize_) + 0.0, std::floor(p.y() / cellSize_) + 0.0,
            std::floor(p.z() / cellSize_) + 0.0};
  }

  const std::vector<Vec3d>& points_;
  double tolerance_;
  double cellSize_ = 0;
  std::unordered_map<Cell, std::vector<Index>, CellHash> cells_;
};

std::vector<Index> weldNear(const std::vector<Vec3d>& points, const std::vector<bool>& used,
                            double tolerance) {
  std::vector<Index> target = numbered(points.size());
  NearPoints stayed(points, tolerance);
  for (Index v = 0; v < points.size(); ++v) {
    if (!used[v]) continue;
    const Index near = stayed.nearest(v);
    if (near == kNone)
      stayed.add(v);
    else
      target[v] = near;
  }
  return target;
}

}  // namespace

std::vector<Index> weldTargets(const std::vector<Vec3d>& points, const std::vector<bool>& used,
                               double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0)
    throw UsageError("the weld tolerance (--weld) must be a finite distance, 0 or more");
  return tolerance == 0 ? weldEqual(points, used) : weldNear(points, used, tolerance);
}

}  // namespace vox
