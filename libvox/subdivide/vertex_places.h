#pragma once

#include "libvox/core/types.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Where the limit point of a vertex of level k >= 1 lies: in the square of a corner of the base
/// mesh (mesh/limit_piece.h), 2^-k away from the squares of its neighbours.
struct VertexPlace {
  Index corner = kNone;  ///< of the base mesh
  float u = 0, v = 0;    ///< exact
  /// Quarter turns, counter-clockwise, from the u axis to the edge that leaves the vertex in the
  /// face that the last step made of a face. Of a boundary vertex: to its boundary edge.
  std::uint8_t turn = 0;
  bool onBoundary = false;  ///< on the curve in which an extended surface ends
};

/// Places of the vertices of the next level.
/// @param places  of those of `level`; empty if it is level 0
/// @param k       number of `level`
/// Precondition: interior vertices of level 0 have three faces or more.
std::vector<VertexPlace> nextPlaces(const SubdivisionLevel& level,
                                    const std::vector<VertexPlace>& places, int k);

/// For each corner of a level >= 1, the quarter turns from the u axis to its edge; the edge that
/// enters the corner comes from one more.
std::vector<std::uint8_t> cornerTurns(const SubdivisionLevel& level,
                                      const std::vector<VertexPlace>& places);

/// The unit vector after some quarter turns from the u axis.
inline Vec2f turnedAxis(unsigned turn) {
  constexpr float kCosine[] = {1, 0, -1, 0};
  return {kCosine[turn % 4], kCosine[(turn + 3) % 4]};
}

}  // namespace vox
