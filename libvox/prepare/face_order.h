#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Rotates the list of a face so that it starts with the lowest vertex; the winding stays.
void startAtLowest(std::span<Index> face);

/// Does so for every face. Parallel.
void startFacesAtLowest(PolygonMesh& mesh);

/// Brings a face of distinct vertices into canonical form: first its lowest vertex, then the lower
/// of the two neighbours of this vertex. Two faces have the same canonical form exactly if they are
/// the same cycle of vertices, in either direction.
/// @return whether the winding was reversed
bool canonicalize(std::span<Index> face);

/// Canonicalizes every face. Parallel.
/// @return for each face, whether its winding was reversed
std::vector<std::uint8_t> canonicalizeFaces(PolygonMesh& mesh);

/// For each face, the first face on the same cycle of vertices, in either direction. Cost
/// O(C log C); parallel in part.
/// @param mesh  faces of distinct vertices
std::vector<Index> firstAlike(const PolygonMesh& mesh);

}  // namespace vox
