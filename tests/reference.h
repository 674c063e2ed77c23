#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/polygon_mesh.h"

/// Slow, obvious second implementations to hold the library against.
namespace vox::test {

/// One Doo-Sabin step by the paper's formula as printed: n^2 weights, and faces found by searching
/// all pairs of corners. Same order of faces and points as the library's.
PolygonMesh naiveDooSabin(const PolygonMesh& mesh);

/// Longest L-inf span over faces, quads split along the better diagonal, found by trying both.
double naiveLargestSpan(const PolygonMesh& mesh);

/// How the inactive voxels in the box of a closed mesh hang together, face to face. A voxel is
/// decided if its centre is farther than 1/2 (L-inf) from the surface; which side it is on follows
/// from the winding number.
struct Sides {
  std::size_t inside = 0;  ///< decided voxels
  std::size_t outside = 0;
  std::size_t components = 0;  ///< 6-connected sets of inactive voxels
  std::size_t leaks = 0;       ///< components with decided voxels of both sides
};
Sides sidesOf(const PolygonMesh& closedMeshIndex, const openvdb::MaskGrid& mask);

}  // namespace vox::test
