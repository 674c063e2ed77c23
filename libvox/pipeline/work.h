#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/volume_options.h"

#include <cstdint>

namespace vox {

// Approximate cost of the stages, in nanoseconds of one thread as once measured. Only the progress
// bar depends on it. Areas are those of control meshes, in square voxels.

/// Makes a mesh an oriented manifold; if it interpolates, moves its vertices.
double workOfPreparing(const PolygonMesh& mesh, bool interpolates);
/// The part of workOfPreparing that is done when interpolation begins.
inline constexpr double kPartBeforeInterpolation = 0.6;
/// Makes the voxels of a surface, or of a part of it.
double workOfSurface(double area, std::uint64_t corners);
/// Makes a grid from the voxels, or from the surfaces.
double workOfGrid(GridKind kind, Edge edge, double area);
/// Writes a grid.
double workOfWriting(GridKind kind, double area);

}  // namespace vox
