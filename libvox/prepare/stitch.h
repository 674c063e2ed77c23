#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/prepare/manifold.h"

#include <vector>

namespace vox {

/// A vertex that enters a face, on the edge of a corner.
struct EdgeVertex {
  Index corner;
  Index vertex;
};

/// The vertices of T-junctions: boundary vertices that lie on a boundary edge of another face,
/// between its ends. Once they are corners of this face, its edge is cut into parts, and the parts
/// join the edges of the faces on the other side. Vertices that would join no edge are left out.
///
/// A vertex lies on an edge if it is not farther from it than the tolerance, and farther from both
/// ends. A vertex also lies on an edge that misses it by rounding alone: by at most 4 units in the
/// last place of the largest coordinate of the ends, along each axis. If all coordinates of the
/// mesh are floats of 32 bits, the error may be less than one unit in the last place of a float,
/// along each axis for itself.
///
/// Edges of three and more faces are no boundary, and a vertex that the face has already does not
/// enter it again.
///
/// @param joints     from joinFaces
/// @param tolerance  in units of the points; vertices are farther apart than this
/// @return           sorted by corner, then along the edge
/// Cost O(C + n log n) for n boundary edges of which few lie on each other. A search of more than
/// some 10^9 steps, or a vertex on more than 16 edges on average, ends without a result. Parallel;
/// result independent of thread count.
std::vector<EdgeVertex> verticesOnEdges(const PolygonMesh& mesh, const Joints& joints,
                                        double tolerance);

/// The mesh with these vertices as corners. Colours are dropped.
/// @throws LimitError  it would have 2^32 - 1 corners or more
PolygonMesh withEdgeVertices(const PolygonMesh& mesh, const std::vector<EdgeVertex>& added);

}  // namespace vox
