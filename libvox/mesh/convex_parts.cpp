// Merging as S. Hertel, K. Mehlhorn, Fast triangulation of simple polygons, 1983; flips as C.
// Lawson, Software for C1 surface interpolation, 1977.
//
// Half-edges: number 3 t + k runs from corner k of triangle t to the next one. Both sides of a
// bridge are half-edges of the same two corners, so bridges are diagonals like all others.

#include "libvox/mesh/convex_parts.h"

#include "libvox/core/forest.h"
#include "libvox/core/numbered.h"
#include "libvox/mesh/bulge.h"
#include "libvox/mesh/join_holes.h"
#include "libvox/mesh/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace vox {
namespace {

constexpr double kFlatSine = 1e-4;
constexpr double kFlatDepth = 1e-7;  // of the extent of the region
constexpr double kMostBulge = 0.25;
constexpr std::size_t kMostCornersAtBends = 256;  // of a part: bounds the cost of a merge
constexpr int kMostPasses = 4;
constexpr std::size_t kFlipsPerTriangle = 64;
constexpr double kLeastGain = 1 + 1e-9;  // of a flip: grids of squares are left alone

using Triangles = std::vector<std::array<Index, 3>>;

class ConvexPartition {
 public:
  ConvexPartition(std::span<const FlatPoint> flat, const Triangles& triangles) : flat_(flat) {
    for (const auto& t : triangles) from_.insert(from_.end(), t.begin(), t.end());
    next_.resize(from_.size());
    previous_.resize(from_.size());
    for (Index t = 0; t < triangles.size(); ++t) link(3 * t, 3 * t + 1, 3 * t + 2);
  }

  /// Finds the two half-edges of each diagonal.
  /// @return false if three meet
  bool pairDiagonals() {
    twin_.assign(from_.size(), kNone);
    std::vector<Index> order = numbered(static_cast<Index>(from_.size()));
    const auto ends = [&](Index h) { return std::minmax({from_[h], to(h)}); };
    std::sort(order.begin(), order.end(),
              [&](Index g, Index h) { return ends(g) != ends(h) ? ends(g) < ends(h) : g < h; });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const Index g = order[k - 1];
      const Index h = order[k];
      if (ends(g) != ends(h)) continue;
      if (from_[g] == from_[h] || twin_[g] != kNone) return false;
      twin_[g] = h;
      twin_[h] = g;
    }
    return true;
  }

  /// Flips diagonals of triangles.
  void flip() {
    std::vector<Index> doubtful = diagonals();
    std::size_t left = kFlipsPerTriangle * from_.size() / 3;
    while (!doubtful.empty() && left > 0) {
      const Index h = doubtful.back();
      doubtful.pop_back();
      if (!isBetterFlipped(h)) continue;
      const Index g = twin_[h];
      const std::array<Index, 4> around = {next_[h], previous_[h], next_[g], previous_[g]};
      from_[h] = from_[around[3]];
      from_[g] = from_[around[1]];
      link(h, around[1], around[2]);
      link(g, around[3], around[0]);
      for (const Index side : around)
        if (twin_[side] != kNone) doubtful.push_back(side);
      --left;
    }
  }

  /// Removes diagonals as long as the parts stay convex and do not bulge.
  void merge(std::span<const std::vector<Index>> loops) {
    bends_ = bendsOf(flat_, loops);
    findBentParts();
    measure();
    std::vector<Index> order = diagonals();
    std::vector<double> length(from_.size());
    for (const Index h : order) length[h] = squaredDistance(at(h), at(next_[h]));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index g, Index h) { return length[g] > length[h]; });
    removed_.assign(from_.size(), false);
    for (int pass = 0; pass < kMostPasses; ++pass) {
      const std::size_t before = order.size();
      std::erase_if(order, [&](Index h) { return removeIfGood(h); });
      if (order.size() == before) break;
    }
  }

  std::vector<std::vector<Index>> parts() const {
    std::vector<std::vector<Index>> all;
    std::vector<bool> seen = removed_;
    for (Index first = 0; first < from_.size(); ++first) {
      if (seen[first]) continue;
      all.emplace_back();
      for (Index h = first; !seen[h]; h = next_[h]) {
        seen[h] = true;
        all.back().push_back(from_[h]);
      }
    }
    return all;
  }

 private:
  Index to(Index h) const { return from_[next_[h]]; }
  const FlatPoint& at(Index h) const { return flat_[from_[h]]; }

  void join(Index before, Index after) {
    next_[before] = after;
    previous_[after] = before;
  }

  void link(Index a, Index b, Index c) {
    join(a, b);
    join(b, c);
    join(c, a);
  }

  /// One half-edge of each diagonal.
  std::vector<Index> diagonals() const {
    std::vector<Index> all;
    for (Index h = 0; h < from_.size(); ++h)
      if (twin_[h] != kNone && h < twin_[h]) all.push_back(h);
    return all;
  }

  /// Sine of the smallest angle of a triangle; negative if it is wound clockwise.
  double smallestSine(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) const {
    std::array<double, 3> sides = {squaredDistance(a, b), squaredDistance(b, c),
                                   squaredDistance(c, a)};
    std::sort(sides.begin(), sides.end());
    const double longer = std::sqrt(sides[1]) * std::sqrt(sides[2]);
    return longer > 0 ? static_cast<double>(turn(a, b, c)) / longer : 0;
  }

  /// Compares smallest angles. They grow with each flip, so flipping ends.
  bool isBetterFlipped(Index h) const {
    const Index g = twin_[h];
    const FlatPoint& a = at(h);
    const FlatPoint& b = at(g);
    const FlatPoint& c = at(previous_[h]);
    const FlatPoint& d = at(previous_[g]);
    if (turn(a, d, c) <= 0 || turn(d, b, c) <= 0) return false;
    const double now = std::min(smallestSine(a, b, c), smallestSine(b, a, d));
    const double then = std::min(smallestSine(a, d, c), smallestSine(d, b, c));
    return then > kLeastGain * now;
  }

  /// Makes each triangle a part.
  void findBentParts() {
    parts_ = Forest(from_.size());
    isBent_.assign(from_.size(), false);
    for (Index h = 0; h < from_.size(); ++h) parts_.unite(h, next_[h]);
    for (Index h = 0; h < from_.size(); ++h)
      if (bends_[from_[h]].size > 0) isBent_[parts_.find(h)] = true;
  }

  /// That of the part of a half-edge (BulgeMeter).
  double bulge(Index h) { return isBent_[parts_.find(h)] ? bulgeOfBent(h) : 0; }

  double bulgeOfBent(Index first) {
    corners_.clear();
    for (Index h = first; corners_.empty() || h != first; h = next_[h]) {
      if (corners_.size() == kMostCornersAtBends) return INFINITY;
      corners_.push_back(from_[h]);
    }
    return meter_.of(corners_, flat_, bends_);
  }

  /// @return whether the diagonal was removed
  bool removeIfGood(Index h) {
    const Index g = twin_[h];
    const std::array<Index, 4> around = {previous_[h], next_[h], previous_[g], next_[g]};
    if (!isConvex(around[0], around[3]) || !isConvex(around[2], around[1])) return false;
    const double before = std::max({kMostBulge, bulge(h), bulge(g)});
    const bool isBent = isBent_[parts_.find(h)] || isBent_[parts_.find(g)];
    join(around[0], around[3]);
    join(around[2], around[1]);
    if (isBent && bulgeOfBent(around[0]) > before) {
      join(around[0], h);
      join(h, around[1]);
      join(around[2], g);
      join(g, around[3]);
      return false;
    }
    parts_.unite(h, g);
    isBent_[parts_.find(h)] = isBent;
    removed_[h] = removed_[g] = true;
    return true;
  }

  void measure() {
    FlatPoint low = flat_[from_[0]];
    FlatPoint high = low;
    for (const Index v : from_) {
      low = {std::min(low.x, flat_[v].x), std::min(low.y, flat_[v].y)};
      high = {std::max(high.x, flat_[v].x), std::max(high.y, flat_[v].y)};
    }
    extent_ = static_cast<double>(std::max(high.x - low.x, high.y - low.y));
  }

  /// Whether the corner between two half-edges is convex.
  bool isConvex(Index before, Index after) const {
    const FlatPoint& a = at(before);
    const FlatPoint& b = at(after);
    const FlatPoint& c = at(next_[after]);
    const auto bend = static_cast<double>(turn(a, b, c));
    if (bend > 0) return true;
    const double ab = std::sqrt(squaredDistance(a, b));
    const double bc = std::sqrt(squaredDistance(b, c));
    const double ac = std::sqrt(squaredDistance(a, c));
    return ac > std::max(ab, bc) && -bend <= kFlatSine * ab * bc &&
           -bend <= kFlatDepth * extent_ * ac;
  }

  std::span<const FlatPoint> flat_;
  std::vector<Index> from_, next_, previous_, twin_;  ///< by half-edge
  std::vector<bool> removed_;
  Forest parts_ = Forest(0);    ///< half-edges of one part
  std::vector<bool> isBent_;    ///< by root of parts_: the part has a corner with a bend
  std::vector<Bend> bends_;     ///< by corner of the region
  std::vector<Index> corners_;  ///< of bulgeOfBent
  BulgeMeter meter_;
  double extent_ = 0;
};

}  // namespace

bool convexParts(std::span<const Vec3d> positions, std::span<const FlatPoint> flat,
                 std::span<const std::vector<Index>> loops,
                 std::vector<std::vector<Index>>& parts) {
  const std::optional<std::vector<Index>> ring = joinHoles(flat, loops);
  if (!ring) return false;
  std::vector<Vec3d> ringPositions;
  std::vector<FlatPoint> ringFlat;
  for (const Index corner : *ring) {
    ringPositions.push_back(positions[corner]);
    ringFlat.push_back(flat[corner]);
  }
  Triangles triangles;
  if (!clipEars(ringPositions, ringFlat, triangles)) return false;
  for (auto& t : triangles) {
    if (turn(ringFlat[t[0]], ringFlat[t[1]], ringFlat[t[2]]) <= 0) return false;
    for (Index& corner : t) corner = (*ring)[corner];
  }
  ConvexPartition partition(flat, triangles);
  if (!partition.pairDiagonals()) return false;
  partition.flip();
  partition.merge(loops);
  parts = partition.parts();
  return true;
}

}  // namespace vox
