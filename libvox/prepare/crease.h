#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/prepare/sharp_features.h"

#include <vector>

namespace vox {

// A crease is an edge at which the smooth surface stays sharp. The control mesh is cut along its
// creases. The boundary of the smooth surface is the quadratic B-spline of a boundary loop,
// whatever the faces are. So both sides of a cut end in the same curve. Source: DESIGN section 19.

struct CreaseCounts {
  Index sharpEdges = 0;
  Index cornerVertices = 0;  ///< vertices that the surface passes through
  Index darts = 0;           ///< vertices at which a crease ends inside the surface
};

/// A mesh cut along its creases. Its faces are those of the mesh before, in the same order.
struct CutMesh {
  PolygonMesh mesh;
  /// Per point: that of the mesh before. The middles of creases of one edge have further numbers.
  std::vector<Index> pointOrigin;
  /// Per corner, for boundary edges: the corner of the edge on the other side of the cut; the
  /// corner itself if the edge has no length; kNone if the edge was on the boundary before.
  /// Other corners have kNone. Empty if nothing was cut.
  std::vector<Index> seam;
  CreaseCounts counts;
};

/// Cuts a mesh along its sharp edges.
/// - A vertex with two sharp edges becomes a copy for each side; the crease is a smooth curve
/// there.
/// - A vertex with three or more, or a marked vertex, becomes a corner vertex. The faces between
/// two sharp
///   edges share m + 1 copies of it, and each face gets an edge without length between two of them.
///   A quadratic B-spline passes through a doubled control point, so the surface passes through the
///   vertex. The two boundary edges at a vertex count as sharp. A marked vertex between two
///   faces, without sharp edges, stays as it is.
/// - A vertex with one sharp edge, a dart, stays. A crease of a single edge with two darts gets a
///   vertex in its middle first.
///
/// @param mesh       an oriented manifold with one fan or ring of faces at each vertex
/// @param adjacency  of the mesh
/// Cost O(C). The result is the mesh itself, and `seam` empty, if nothing is sharp.
CutMesh cutCreases(PolygonMesh mesh, Adjacency adjacency, SharpFeatures sharp);

/// A refined mesh without its cuts: boundary vertices at exactly the same place become one, and
/// corners that repeat the one before are dropped. Faces keep their order.
/// @param adjacency  of the mesh
PolygonMesh joinedAlongCreases(const PolygonMesh& mesh, const Adjacency& adjacency);

}  // namespace vox
