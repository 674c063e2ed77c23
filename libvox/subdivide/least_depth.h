#pragma once

#include "libvox/subdivide/vertex_array.h"

#include <cstdint>

namespace vox {

// The least depth at which something holds.

inline VertexDepth squareOf(int k) {
  return {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k)};
}

/// Least k <= most for which fine(k) holds, else most.
template <class Fine>
int leastDepth(int most, Fine&& fine) {
  int k = 0;
  while (k < most && !fine(k)) ++k;
  return k;
}

/// From the least depth that is the same along u and v, lessens one axis and then the other, both
/// ways round. Calls fine(u, v).
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
