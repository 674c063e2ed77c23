#pragma once

#include "libvox/subdivide/level.h"

#include <vector>

namespace vox {

/// A set of faces that are connected through edges, also across creases.
struct MeshComponent {
  std::vector<Index> faces;      ///< ascending
  Index boundaryCorner = kNone;  ///< a corner whose edge has no other face; kNone if closed
  enum class Side { kOut, kIn, kNoInside } side = Side::kNoInside;
};

/// The components of a prepared mesh, in the order of their lowest faces. The sign of its volume
/// tells whether a closed component faces outward or inward. A component with boundary, or without
/// volume (a one-sided surface), has no inside.
std::vector<MeshComponent> componentsOf(const SubdivisionLevel& base);

/// A mesh of some faces, and of the points that these use.
PolygonMesh submeshOf(const PolygonMesh& mesh, const std::vector<Index>& faces);

}  // namespace vox
