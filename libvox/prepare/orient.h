#pragma once

#include "libvox/core/origins.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <string>
#include <vector>

namespace vox {

/// Counts and origins of orient.
struct OrientReport {
  Index components = 0;         ///< sets of faces that are connected through edges
  Index closedComponents = 0;   ///< two-sided components without boundary
  Index openComponents = 0;     ///< two-sided components with boundary
  Index flippedFaces = 0;       ///< faces of the input that the output has reversed
  Index firstFlipped = kNone;   ///< the lowest of them
  Index cavities = 0;           ///< closed components left facing inward, inside another one
  std::vector<Index> oneSided;  ///< lowest face of each component that cannot be oriented
  /// First face of the output that belongs to the second side of a one-sided component; so do all
  /// faces after it.
  Index secondSide = 0;
  Origins pointOrigin;  ///< input point of each point of the output
  Origins faceOrigin;   ///< input face of each face of the output
  Adjacency adjacency;  ///< of the output
};

/// Summary in one line: "flipped 12 faces, doubled 1 one-sided component (face 0)"; empty if
/// nothing changed.
std::string summary(const OrientReport& report);

/// The mesh with consistent winding. requireManifold accepts the result, and findDefects finds
/// nothing in it.
///
/// @param mesh  as repair() returns it: any winding, at most two faces at an edge, one fan of faces
///              at a vertex
///
/// Each component is wound consistently, then turned as a whole:
///  - closed: outward (positive signed volume). Exception: a component that is consistently wound
///    in the input, faces inward there and lies inside another closed component is a cavity and
///    stays as it is. The search for the outer component ends after some 10^9 steps; further
///    components are then turned outward.
///  - open, or without volume: as the majority of its faces in the input; on a tie, as its lowest
///    face.
///  - one-sided (Moebius strip, Klein bottle): replaced by its two-sided double cover. Each face is
///    there twice, once in each direction, and walking once around the strip leads from one side to
///    the other. The limit surface, its boundary curve and lifting are exactly those of the
///    one-sided surface, without any seam (a cut would leave notches at the boundary). Normals have
///    no global sign there and cancel in sums over both sides. A caller that needs one side only
///    skips all descendants of the faces from `secondSide` on.
///
/// Canonical form: every face starts at its lowest vertex. So rotated or flipped faces in the input
/// do not change one bit of the output, except by the two rules that look at the winding of the
/// input: majority and cavities. Faces and points keep their order; those of second sides follow at
/// the end.
///
/// @throws LimitError  a double cover would have 2^32 - 1 corners or more
/// Cost O(C log C) besides the search for cavities. Parallel in part; result independent of thread
/// count. Source: paper section 8.
PolygonMesh orient(PolygonMesh mesh, OrientReport& report);

/// The same, if the faces start at their lowest vertices and the joints of the mesh are known.
/// @param joints  as joinFaces(mesh, CrowdedEdge::kSeparate) finds them
PolygonMesh orient(PolygonMesh mesh, Adjacency joints, OrientReport& report);

}  // namespace vox
