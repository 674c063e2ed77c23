#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/prepare/sharp_features.h"

#include <vector>

namespace vox {

/// A place on an edge of the input.
struct EdgePlace {
  Index corner;  ///< of the input, whose edge it is
  double along;  ///< 0: at the vertex of the corner; 1: at that of the next corner
};

/// For each corner of a prepared mesh, its place on the outline of the face that it comes from. So
/// what the input has at corners can follow. Vertices that entered a face lie on an edge of it; the
/// nearest one is taken. Of several corners at one vertex, the one with the same neighbours is.
/// @param input  with which `origin` was made
/// @param mesh   positions as in the input; not yet interpolated
/// Cost O(C), times the size of the face for corners that are not its vertices. Parallel.
std::vector<EdgePlace> cornerOrigins(const PolygonMesh& input, const PolygonMesh& mesh,
                                     const InputElements& origin);

/// The texture coordinates of the corners of a prepared mesh; none if the input has none.
std::vector<Vec2f> followedTexcoords(const PolygonMesh& input, const PolygonMesh& mesh,
                                     const InputElements& origin);

}  // namespace vox
