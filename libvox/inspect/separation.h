#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/inspect/diff.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/voxelize.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vox {

/// A surface that voxels are compared with, in index space. Two triangles are neighbours if two of
/// their corners lie at the same places. A side without neighbour is a boundary.
struct ReferenceSurface {
  std::vector<Vec3d> points;
  std::vector<std::array<Index, 3>> triangles;
  /// Largest distance of the surface that was voxelized from this one, in voxels (L-inf): 0 if it
  /// consists of these very triangles.
  double tolerance = 0;
};

/// The polygons of a mesh, cut into triangles.
ReferenceSurface referenceSurface(PolygonMesh mesh, double tolerance);

/// The least whole tolerance at which the layer around a reference holds all voxels that another
/// surface meets. Nothing if it is above 32.
std::optional<int> reachOf(const ReferenceSurface& reference, const ReferenceSurface& other);

struct SeparationReport {
  std::uint64_t tunnels = 0;        ///< places where the surface is open
  std::optional<VoxelIndex> first;  ///< voxel at such a place with the lowest x, then y, then z
};

/// Looks for tunnels of a surface, closed or open, orientable or not.
///
/// k6: a tunnel is a path of inactive voxels, face to face, that starts farther than 1/2 (L-inf)
/// from the surface, crosses it an odd number of times and ends as far from it again. (A step that
/// crosses into a pocket is no tunnel.) A flood that counts crossings modulo 2 looks for such paths
/// in the layer of voxels around the surface. Steps beside the boundary of an open surface do not
/// count: the voxels may end a little earlier there, by up to 2 voxels and the tolerance. Crossings
/// are decided exactly, on a lattice of 2^-16 voxels.
///
/// k26: a tunnel is an inactive voxel whose closed cube meets the surface.
///
/// A one-sided surface that preparation has doubled counts as one surface. Costs some microseconds
/// and 50 bytes per voxel of the layer; serial.
/// @throws LimitError  as scanTriangles
SeparationReport findTunnels(const openvdb::MaskTree& voxels, const ReferenceSurface& surface,
                             Separation separation);

}  // namespace vox
