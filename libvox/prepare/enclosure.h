#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <span>

namespace vox {

/// Volume inside a closed set of faces, positive if they face outward, and the size of the numbers
/// it was summed from: a volume below 1e-12 of that is rounding.
struct SignedVolume {
  double volume = 0;
  double scale = 0;
  int sign() const { return volume > 1e-12 * scale ? 1 : volume < -1e-12 * scale ? -1 : 0; }
};

/// Sum over the faces, each seen as a fan of triangles from its first corner. Serial, in order.
SignedVolume signedVolume(const PolygonMesh& mesh, std::span<const Index> faces);

/// Whether a closed set of faces winds around the point an odd number of times along the ray in +x,
/// whatever the winding of the faces. The ray passes edges and vertices as if the point lay a
/// little further in +y and +z, so shared edges count once. A point on the surface may go either
/// way.
bool encloses(const PolygonMesh& mesh, std::span<const Index> faces, const Vec3d& point);

}  // namespace vox
