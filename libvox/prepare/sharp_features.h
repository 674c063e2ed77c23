#pragma once

#include "libvox/core/origins.h"
#include "libvox/core/types.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// What stays sharp in a sound mesh.
struct SharpFeatures {
  std::vector<bool> edges;  ///< per corner: whether its edge is sharp; twins have the same value
  std::vector<bool>
      vertices;  ///< per point: whether it is a corner vertex, which the surface passes through
};
SharpFeatures nothingSharp(const PolygonMesh& mesh);

/// The elements of the input that a sound mesh comes from.
struct InputElements {
  const Origins& weldedTo;  ///< per input point: the one that it was welded to, or itself
  const Origins& points;    ///< per point of the mesh: an input point
  const Origins& faces;     ///< per face of the mesh: an input face
};

// Each function marks more edges or vertices. Edges between two parts of one input face are never
// sharp by angle or group.

/// Edges whose faces turn by more than an angle. The cosine of the angle counts, with a tolerance
/// of 1e-12. A face without area has no angle.
/// @param degrees  0 to 180
void markByAngle(const PolygonMesh& mesh, const Adjacency& adjacency, const InputElements& input,
                 double degrees, SharpFeatures& sharp);

/// Edges between different smoothing groups, and all edges of faces in group 0.
/// @param groups  per input face
void markByGroups(const Adjacency& adjacency, const InputElements& input,
                  std::span<const std::uint32_t> groups, SharpFeatures& sharp);

/// Edges between given pairs of input points.
/// @return the pairs that are no edges of the mesh, by their places, ascending
/// @throws MeshError  a point does not exist
std::vector<std::size_t> markByPoints(const PolygonMesh& mesh, const Adjacency& adjacency,
                                      const InputElements& input, std::span<const PointPair> pairs,
                                      SharpFeatures& sharp);

/// Vertices that come from given input points.
/// @throws MeshError  a point does not exist
void markVertices(const InputElements& input, std::span<const Index> points, SharpFeatures& sharp);

/// Boundary vertices that only one face has.
void markBoundaryCorners(const PolygonMesh& mesh, const Adjacency& adjacency, SharpFeatures& sharp);

}  // namespace vox
