#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Rotates a face so that it starts at its lowest vertex; the winding stays.
void startAtLowest(std::span<Index> face);

/// Brings a face of distinct vertices into canonical form: it starts at its lowest vertex and goes
/// on to the lower one of that vertex's two neighbours. Two faces have the same canonical form
/// exactly when they are the same cycle, in either direction.
/// @return whether the winding was reversed
bool canonicalize(std::span<Index> face);

/// Canonicalizes every face; slot f of the result says whether face f was reversed. Parallel.
std::vector<std::uint8_t> canonicalizeFaces(PolygonMesh& mesh);

/// For each face, the first face on the same cycle of vertices, in either direction. Cost
/// O(C log C); parallel in part.
/// @param mesh  faces of distinct vertices
std::vector<Index> firstAlike(const PolygonMesh& mesh);

}  // namespace vox
