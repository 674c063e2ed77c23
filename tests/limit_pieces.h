#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <array>
#include <vector>

namespace vox::test {

/// A limit surface, cut into pieces that meet along their sides.
struct LimitPieces {
  /// Each covers the square [0, 1]^2 of its parameters; u, v and the outward normal are
  /// right-handed.
  std::vector<Patch> patches;
  /// What is left around extraordinary faces, with corners on the limit surface, wound outward.
  std::vector<std::array<Vec3d, 3>> triangles;
};

/// Cuts a limit surface into pieces, by steps of the whole mesh.
///
/// A vertex with four quads around it becomes a patch at the first level at which it is one. Later
/// steps leave out the faces that are not near any other vertex. Around the vertices that are left
/// in the end, triangles join the limit points of vertices and faces; they are 2^-levels of a face
/// in size. Patches along an extended boundary end in its curve. Along a free boundary, only
/// vertices with all of their faces count.
///
/// @param base    level 0
/// @param levels  steps, at least 2 (else 2): only then does every vertex have four faces
/// Source: Doo & Sabin 1978; DESIGN sections 4 and 6.
LimitPieces limitPieces(const SubdivisionLevel& base, int levels);

}  // namespace vox::test
