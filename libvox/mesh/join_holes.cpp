// The leftmost hole that is not joined yet always sees a corner of what is joined: the ray to the
// left meets a joined side, and the triangle of the ray and one end of the side holds no other
// hole.

#include "libvox/mesh/join_holes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vox {
namespace {

/// Whether the ray from corner b towards q starts into the polygon, whose corners run a, b, c.
bool entersAt(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c, const FlatPoint& q) {
  if (turn(a, b, c) >= 0) return turn(b, q, a) > 0 && turn(q, b, c) > 0;
  return !(turn(b, q, c) >= 0 && turn(q, b, a) >= 0);
}

class HoleJoiner {
 public:
  HoleJoiner(std::span<const FlatPoint> flat, std::span<const std::vector<Index>> loops)
      : flat_(flat), ring_(loops[0]) {
    for (const std::vector<Index>& loop : loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        sides_.emplace_back(loop[i], loop[(i + 1) % loop.size()]);
        shared_.push_back(flat[loop[i]]);
      }
    // Of the positions keep those of two corners and more.
    std::sort(shared_.begin(), shared_.end());
    std::size_t kept = 0;
    for (std::size_t k = 1; k < shared_.size(); ++k)
      if (shared_[k] == shared_[k - 1]) shared_[kept++] = shared_[k];
    shared_.resize(kept);
  }

  /// Joins a hole that starts at its leftmost corner.
  bool join(std::vector<Index> hole) {
    for (std::size_t i = 0; i < hole.size(); ++i) {
      if (std::binary_search(shared_.begin(), shared_.end(), flat_[hole[0]]))
        for (std::size_t k = 0; k < ring_.size(); ++k)
          if (touches(k, hole)) {
            hole.push_back(ring_[k]);
            insertAfter(k, {hole.begin() + 1, hole.end()});
            return true;
          }
      std::rotate(hole.begin(), hole.begin() + 1, hole.end());
    }
    std::vector<std::size_t> nearest(ring_.size());
    for (std::size_t k = 0; k < nearest.size(); ++k) nearest[k] = k;
    const auto farther = [&](std::size_t k, std::size_t l) {
      const double dk = squaredDistance(flat_[ring_[k]], flat_[hole[0]]);
      const double dl = squaredDistance(flat_[ring_[l]], flat_[hole[0]]);
      return dk != dl ? dk > dl : k > l;
    };
    std::make_heap(nearest.begin(), nearest.end(), farther);
    while (!nearest.empty()) {
      std::pop_heap(nearest.begin(), nearest.end(), farther);
      const std::size_t k = nearest.back();
      nearest.pop_back();
      if (!sees(k, hole)) continue;
      sides_.emplace_back(ring_[k], hole[0]);
      hole.push_back(hole[0]);
      hole.push_back(ring_[k]);
      insertAfter(k, hole);
      return true;
    }
    return false;
  }

  std::vector<Index> takeRing() { return std::move(ring_); }

 private:
  const FlatPoint& at(std::size_t k) const { return flat_[ring_[k % ring_.size()]]; }

  /// Whether the ray from entry k of the ring towards q starts into the polygon.
  bool enters(std::size_t k, const FlatPoint& q) const {
    return entersAt(at(k + ring_.size() - 1), at(k), at(k + 1), q);
  }

  bool touches(std::size_t k, const std::vector<Index>& hole) const {
    return at(k) == flat_[hole[0]] && enters(k, flat_[hole[1]]);
  }

  bool sees(std::size_t k, const std::vector<Index>& hole) const {
    const FlatPoint& p = at(k);
    const FlatPoint& q = flat_[hole[0]];
    if (p == q || !enters(k, q) || !entersAt(flat_[hole.back()], q, flat_[hole[1]], p))
      return false;
    return std::none_of(sides_.begin(), sides_.end(),
                        [&](const auto& side) { return blocks(side, p, q); });
  }

  /// Whether a side meets the segment from p to q elsewhere than in a common end.
  bool blocks(const std::pair<Index, Index>& side, const FlatPoint& p, const FlatPoint& q) const {
    const FlatPoint& a = flat_[side.first];
    const FlatPoint& b = flat_[side.second];
    if (std::max(a.x, b.x) < std::min(p.x, q.x) || std::min(a.x, b.x) > std::max(p.x, q.x) ||
        std::max(a.y, b.y) < std::min(p.y, q.y) || std::min(a.y, b.y) > std::max(p.y, q.y))
      return false;
    const Int128 ofA = turn(p, q, a);
    const Int128 ofB = turn(p, q, b);
    if ((ofA > 0 && ofB > 0) || (ofA < 0 && ofB < 0)) return false;
    const bool aIsEnd = a == p || a == q;
    const bool bIsEnd = b == p || b == q;
    if (aIsEnd && bIsEnd) return true;
    if (aIsEnd) return ofB == 0 && isBetween(b, p, q);
    if (bIsEnd) return ofA == 0 && isBetween(a, p, q);
    const Int128 ofP = turn(a, b, p);
    const Int128 ofQ = turn(a, b, q);
    return !((ofP > 0 && ofQ > 0) || (ofP < 0 && ofQ < 0));
  }

  /// Whether a point on the line of p and q is in the box of both.
  static bool isBetween(const FlatPoint& a, const FlatPoint& p, const FlatPoint& q) {
    return std::min(p.x, q.x) <= a.x && a.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= a.y &&
           a.y <= std::max(p.y, q.y);
  }

  void insertAfter(std::size_t k, const std::vector<Index>& part) {
    ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(k) + 1, part.begin(), part.end());
  }

  std::span<const FlatPoint> flat_;
  std::vector<Index> ring_;
  std::vector<std::pair<Index, Index>> sides_;  ///< of all loops, and the bridges
  std::vector<FlatPoint> shared_;  ///< positions where corners of several loops lie, sorted
};

}  // namespace

std::optional<std::vector<Index>> joinHoles(std::span<const FlatPoint> flat,
                                            std::span<const std::vector<Index>> loops) {
  if (loops.size() == 1) return loops[0];
  const auto isLeft = [&](Index a, Index b) { return flat[a] < flat[b]; };
  std::vector<std::vector<Index>> holes(loops.begin() + 1, loops.end());
  for (std::vector<Index>& hole : holes)
    std::rotate(hole.begin(), std::min_element(hole.begin(), hole.end(), isLeft), hole.end());
  std::stable_sort(holes.begin(), holes.end(),
                   [&](const auto& g, const auto& h) { return isLeft(g[0], h[0]); });
  HoleJoiner joiner(flat, loops);
  for (const std::vector<Index>& hole : holes)
    if (!joiner.join(hole)) return std::nullopt;
  return joiner.takeRing();
}

}  // namespace vox
