// Images of corners, as in one step of D. Doo, M. Sabin, Behaviour of recursive division surfaces
// near extraordinary points, 1978.

#include "libvox/mesh/bulge.h"

#include <algorithm>
#include <cstddef>

namespace vox {
namespace {

Eigen::Vector2d vectorTo(const FlatPoint& a, const FlatPoint& b) {
  return {static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)};
}

}  // namespace

std::vector<Bend> bendsOf(std::span<const FlatPoint> flat,
                          std::span<const std::vector<Index>> loops) {
  std::vector<Bend> bends(flat.size());
  for (const std::vector<Index>& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const FlatPoint& before = flat[loop[i == 0 ? loop.size() - 1 : i - 1]];
      const FlatPoint& here = flat[loop[i]];
      const FlatPoint& after = flat[loop[(i + 1) % loop.size()]];
      if (turn(before, here, after) >= 0) continue;
      const Eigen::Vector2d a = vectorTo(here, before);
      const Eigen::Vector2d b = vectorTo(here, after);
      const Eigen::Vector2d across = b.normalized() - a.normalized();
      bends[loop[i]] = {Eigen::Vector2d(across.y(), -across.x()).normalized(),
                        std::min(a.norm(), b.norm())};
    }
  return bends;
}

double BulgeMeter::of(std::span<const Index> part, std::span<const FlatPoint> flat,
                      std::span<const Bend> bends) {
  const std::size_t n = part.size();
  if (roots_.size() <= n) roots_.resize(n + 1);
  if (roots_[n].empty()) roots_[n] = unitRoots(static_cast<Index>(n));
  const std::vector<UnitRoot>& roots = roots_[n];
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d cosines = sum;
  Eigen::Vector2d sines = sum;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d v = vectorTo(flat[part[0]], flat[part[i]]);
    sum += v;
    cosines += roots[i].cosine * v;
    sines += roots[i].sine * v;
  }
  double worst = 0;
  const auto count = static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Bend& bend = bends[part[i]];
    if (bend.size == 0) continue;
    const Eigen::Vector2d v = vectorTo(flat[part[0]], flat[part[i]]);
    const Eigen::Vector2d image =
        v / 4 + (0.75 / count) * sum +
        (0.5 / count) * (roots[i].cosine * cosines + roots[i].sine * sines);
    worst = std::max(worst, (image - v).dot(bend.outward) / bend.size);
  }
  return worst;
}

}  // namespace vox
