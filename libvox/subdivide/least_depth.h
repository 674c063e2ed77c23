#pragma once

#include "libvox/subdivide/vertex_array.h"

#include <cstdint>

namespace vox {

// Least depths at which a condition holds.

/// The same depth along u and v.
inline VertexDepth squareOf(int k) {
  return {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k)};
}

/// Least k < most for which fine(k) holds; `most` if there is none.
template <class Fine>
int leastDepth(int most, Fine&& fine) {
  int k = 0;
  while (k < most && !fine(k)) ++k;
  return k;
}

/// Depths along u and v at which fine(u, v) holds, with few vertices. Starts from the least equal
/// depths; lowers one axis as far as possible and then the other. Tries both orders of the axes and
/// returns the better result.
template <class Fine>
VertexDepth leastDepths(int most, Fine&& fine) {
  const int k = leastDepth(most, [&](int depth) { return fine(depth, depth); });
  int u = k;
  int v = k;
  while (u > 0 && fine(u - 1, v)) --u;
  while (v > 0 && fine(u, v - 1)) --v;
  int otherU = k;
  int otherV = k;
  while (otherV > 0 && fine(otherU, otherV - 1)) --otherV;
  while (otherU > 0 && fine(otherU - 1, otherV)) --otherU;
  const bool other = otherU + otherV < u + v;
  return {static_cast<std::uint8_t>(other ? otherU : u),
          static_cast<std::uint8_t>(other ? otherV : v)};
}

}  // namespace vox
