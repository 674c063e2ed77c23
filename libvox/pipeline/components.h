#pragma once

#include "libvox/subdivide/level.h"

#include <vector>

namespace vox {

/// Faces that hang together along edges.
struct MeshComponent {
  std::vector<Index> faces;      ///< ascending
  Index boundaryCorner = kNone;  ///< a corner whose edge has no other face, or none
  enum class Side { kOut, kIn, kNoInside } side = Side::kNoInside;
};

/// The components of a prepared mesh, by their lowest faces. A closed one faces outward or inward
/// by its volume; one with boundary, or without volume (a one-sided surface), has no inside.
std::vector<MeshComponent> componentsOf(const SubdivisionLevel& base);

/// The mesh of some faces, with the points that they use.
PolygonMesh submeshOf(const PolygonMesh& mesh, const std::vector<Index>& faces);

}  // namespace vox
