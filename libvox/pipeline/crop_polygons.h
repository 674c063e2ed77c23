#pragma once

#include "libvox/grid/transform.h"
#include "libvox/mesh/polygon_mesh.h"

namespace vox {

/// The part of a mesh in a box, as polygons without common points. Faces count as fans of triangles
/// from their first corners. Cost O(C).
PolygonMesh croppedTo(const Box& box, const PolygonMesh& mesh);

/// The volume inside a closed mesh that lies in a box; negative if the faces face inward. Cost
/// O(C). By Gauss's theorem it is the flux, through the surface between the four sides of the box,
/// of the field (0, 0, h): h is the height above the floor of the box, at most that of the box.
double volumeWithin(const Box& box, const PolygonMesh& mesh);

}  // namespace vox
