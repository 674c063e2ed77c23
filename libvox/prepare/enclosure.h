#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <span>

namespace vox {

/// Volume inside a closed set of faces, positive if the faces face outward. `scale` is the sum of
/// the absolute values of the terms: a volume below 1e-12 of it is taken for rounding.
struct SignedVolume {
  double volume = 0;
  double scale = 0;
  SignedVolume& operator+=(const SignedVolume& part) {
    volume += part.volume;
    scale += part.scale;
    return *this;
  }
  int sign() const { return volume > 1e-12 * scale ? 1 : volume < -1e-12 * scale ? -1 : 0; }
};

/// Signed volume of a closed set of faces, each cut into a fan of triangles from its first corner.
/// Parallel; the result does not depend on threads.
SignedVolume signedVolume(const PolygonMesh& mesh, std::span<const Index> faces);

/// Whether the ray from a point in +x crosses a closed set of faces an odd number of times. The
/// winding of the faces does not matter. At edges and vertices the ray counts as shifted a little
/// in +y and +z, so that a shared edge counts once. For a point on the surface either result is
/// possible.
bool encloses(const PolygonMesh& mesh, std::span<const Index> faces, const Vec3d& point);

}  // namespace vox
