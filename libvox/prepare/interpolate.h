#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/smoothing_options.h"
#include "libvox/prepare/lift.h"

#include <span>

namespace vox {

/// What interpolation did.
struct InterpolationReport {
  Index boundaryVertices = 0;  ///< moved by boundary interpolation
  LiftReport lift;
};

/// Moves vertices so that the smooth surface passes through where they were: every interior vertex
/// (of a closed ring of 3 faces or more), every boundary vertex (through the boundary curve of an
/// extended surface), both, or none, and besides these the prescribed ones. Boundary first; its
/// control points stay where lifting finds them.
/// @throws MeshError, LimitError  as lift and interpolateBoundary; a prescribed boundary vertex is
///   an error unless the boundary is interpolated
PolygonMesh interpolate(PolygonMesh mesh, const Adjacency& adjacency, Interpolate which,
                        std::span<const Index> prescribed, InterpolationReport& report);

}  // namespace vox
