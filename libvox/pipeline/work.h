#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>

namespace vox {

// What stages cost beside each other, in nanoseconds of one thread as once measured. Only the bar
// that shows how far a run has come depends on it.

/// Of making a mesh an oriented manifold, and of moving its vertices where it is to interpolate.
double workOfPreparing(const PolygonMesh& mesh, bool interpolates);
/// What of it is done when interpolation begins.
inline constexpr double kPartBeforeInterpolation = 0.6;
/// Of a surface, or a part of it.
/// @param area  of its control mesh, in square voxels
double workOfSurface(double area, std::uint64_t corners);
/// Of turning the voxels into a density grid.
double workOfDensity(double area);
/// Of finding the normals of the voxels.
double workOfNormals(double area);
/// Of colouring them.
double workOfColor(double area);
/// Of writing a grid.
double workOfWritingMask(double area);
double workOfWritingDensity(double area);
double workOfWritingNormals(double area);
double workOfWritingColor(double area);

}  // namespace vox
