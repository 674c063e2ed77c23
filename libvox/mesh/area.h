#pragma once

#include "libvox/mesh/polygon_mesh.h"

namespace vox {

/// Area of a face by its average normal, in the square of the unit of the points.
double areaOf(const PolygonMesh& mesh, Index face);

/// The sum over all faces.
double areaOf(const PolygonMesh& mesh);

}  // namespace vox
