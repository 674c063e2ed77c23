// Equal points are found by their hashes, bucket by bucket: a table tells which buckets have any,
// and these are sorted. Near points are found by a grid of cells as wide as the tolerance. The
// points that stay are further apart than the tolerance, so a cell holds only a few of them.

#include "libvox/prepare/weld.h"

#include "libvox/core/buckets.h"
#include "libvox/core/error.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <span>
#include <unordered_map>
#include <utility>

namespace vox {
namespace {

/// 32 bits that equal points share.
std::uint32_t hashOf(const Vec3d& point) {
  std::uint64_t hash = 0;
  for (const double x : point) {
    hash ^= std::bit_cast<std::uint64_t>(x + 0.0);  // + 0 turns -0 into +0
    hash *= 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32U;
  }
  return static_cast<std::uint32_t>(hash);
}

/// A point, and its hash in the upper half.
using HashedPoint = std::uint64_t;

Index pointOf(HashedPoint hashed) {
  return static_cast<Index>(hashed);
}

/// The targets of points, made when the first one is welded. Threads may weld points that have
/// nothing in common at the same time.
class Targets {
 public:
  explicit Targets(std::size_t count) : count_(static_cast<Index>(count)) {}

  /// Welds v to the target of `to`.
  void weld(Index v, Index to) {
    std::call_once(areMade_, [&] { targets_ = numbered(count_); });
    targets_[v] = targets_[to];
  }
  Origins take() { return targets_.empty() ? Origins(count_) : Origins(std::move(targets_)); }

 private:
  Index count_;
  std::once_flag areMade_;
  std::vector<Index> targets_;
};

/// Welds equal points among those of one hash.
void weldAlike(const std::vector<Vec3d>& points, std::span<HashedPoint> alike, Targets& targets) {
  const auto before = [&](HashedPoint a, HashedPoint b) {
    const Vec3d& p = points[pointOf(a)];
    const Vec3d& q = points[pointOf(b)];
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != q[axis]) return p[axis] < q[axis];
    return a < b;
  };
  std::sort(alike.begin(), alike.end(), before);
  for (std::size_t k = 1; k < alike.size(); ++k)
    if (points[pointOf(alike[k])] == points[pointOf(alike[k - 1])])
      targets.weld(pointOf(alike[k]), pointOf(alike[k - 1]));
}

bool haveSameHash(HashedPoint a, HashedPoint b) {
  return a >> 32U == b >> 32U;
}

/// Whether two of the points are equal. A table of open addresses.
bool haveRepeats(const std::vector<Vec3d>& points, std::span<const HashedPoint> hashed) {
  constexpr HashedPoint kFree = kNone;
  const std::size_t slots = std::bit_ceil(2 * hashed.size() + 1);
  std::vector<HashedPoint> table(slots, kFree);
  for (const HashedPoint point : hashed) {
    std::size_t slot = (((point >> 32U) + 1) * 0x9e3779b97f4a7c15ULL >> 32U) & (slots - 1);
    for (; table[slot] != kFree; slot = (slot + 1) & (slots - 1))
      if (haveSameHash(table[slot], point) &&
          points[pointOf(table[slot])] == points[pointOf(point)])
        return true;
    table[slot] = point;
  }
  return false;
}

/// Welds equal points among those of a bucket.
void weldBucket(const std::vector<Vec3d>& points, std::span<const HashedPoint> bucket,
                Targets& targets) {
  if (!haveRepeats(points, bucket)) return;
  std::vector<HashedPoint> sorted(bucket.begin(), bucket.end());
  std::sort(sorted.begin(), sorted.end());
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first + 1, sorted.end(),
                                   [&](HashedPoint other) { return !haveSameHash(*first, other); });
    if (last - first > 1) weldAlike(points, {first, last}, targets);
    first = last;
  }
}

Origins weldEqual(const std::vector<Vec3d>& points, const std::vector<std::uint8_t>& used) {
  constexpr std::size_t kPointsPerBucket = 2048;
  const auto count = static_cast<Index>(points.size() / kPointsPerBucket + 1);
  const Buckets<HashedPoint> buckets(static_cast<Index>(points.size()), count,
                                     [&](Index v, auto&& put) {
                                       if (!used[v]) return;
                                       const std::uint32_t hash = hashOf(points[v]);
                                       put(hash % count, HashedPoint{hash} << 32U | v);
                                     });
  Targets targets(points.size());
  parallelForEach(count, 1, [&](Index b) { weldBucket(points, buckets[b], targets); });
  return targets.take();
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

Origins weldNear(const std::vector<Vec3d>& points, const std::vector<std::uint8_t>& used,
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

Origins weldTargets(const std::vector<Vec3d>& points, const std::vector<std::uint8_t>& used,
                    double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0)
    throw UsageError("the weld tolerance (--weld) must be a finite distance, 0 or more");
  return tolerance == 0 ? weldEqual(points, used) : weldNear(points, used, tolerance);
}

}  // namespace vox
