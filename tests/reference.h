#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/polygon_mesh.h"

/// Slow but obvious implementations, with which tests compare the library.
namespace vox::test {

/// One Doo-Sabin step by the paper's formula as printed: n^2 weights, and faces found by searching
/// all pairs of corners. Same order of faces and points as the library's.
PolygonMesh naiveDooSabin(const PolygonMesh& mesh);

/// Longest L-inf span over faces, quads split along the better diagonal, found by trying both.
double naiveLargestSpan(const PolygonMesh& mesh);

/// Connected sets, face to face, of the inactive voxels in the box of a closed mesh. A voxel is
/// decided if its centre is farther than 1/2 (L-inf) from the surface; the winding number gives its
/// side.
struct Sides {
  std::size_t inside = 0;  ///< decided voxels
  std::size_t outside = 0;
  std::size_t components = 0;  ///< 6-connected sets of inactive voxels
  std::size_t leaks = 0;       ///< components with decided voxels on both sides
};
Sides sidesOf(const PolygonMesh& closedMeshIndex, const openvdb::MaskGrid& mask);

}  // namespace vox::test
