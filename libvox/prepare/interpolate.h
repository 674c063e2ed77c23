#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/smoothing_options.h"
#include "libvox/prepare/boundary.h"
#include "libvox/prepare/lift.h"

#include <span>

namespace vox {

/// Counts of interpolate.
struct InterpolationReport {
  Index boundaryVertices = 0;  ///< moved by boundary interpolation
  LiftReport lift;
};

/// Moves vertices so that the smooth surface passes through their old positions. The boundary comes
/// first (interpolateBoundary), then the interior vertices (lift), which leaves the control points
/// of the boundary in place.
///
/// @param which       all interior vertices (those with a closed one-ring of 3 faces or more), all
///   boundary vertices, both, or none
/// @param prescribed  interior vertices to interpolate besides
/// @param cut         where the mesh was cut along creases. Creases are boundary; corners need no
///   interpolation
/// @throws MeshError, LimitError  as lift and interpolateBoundary; a prescribed boundary vertex is
///   an error unless the boundary is interpolated
PolygonMesh interpolate(PolygonMesh mesh, const Adjacency& adjacency, Interpolate which,
                        std::span<const Index> prescribed, InterpolationReport& report,
                        const CreaseCut& cut = {});

}  // namespace vox
