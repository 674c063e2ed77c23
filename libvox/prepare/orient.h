#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <string>
#include <vector>

namespace vox {

/// What orient found and did.
struct OrientReport {
  Index components = 0;         ///< sets of faces that hang together along edges
  Index closedComponents = 0;   ///< those without boundary (and two-sided); the rest is open
  Index openComponents = 0;     ///< those with boundary (and two-sided)
  Index flippedFaces = 0;       ///< faces wound against the input in the output
  Index firstFlipped = kNone;   ///< the lowest of them
  Index cavities = 0;           ///< closed components left facing inward, inside another one
  std::vector<Index> oneSided;  ///< lowest face of each component that cannot be oriented
  /// Faces of the output from this one on are the second side of one-sided components.
  Index secondSide = 0;
  std::vector<Index> pointOrigin;  ///< input point of each point of the output
  std::vector<Index> faceOrigin;   ///< input face of each face of the output
};

/// One line: "flipped 12 faces, doubled 1 one-sided component (face 0)"; empty if nothing changed.
std::string summary(const OrientReport& report);

/// The mesh with consistent winding: requireManifold and findDefects have nothing to say against
/// the result.
///
/// @param mesh  as repair() returns it: any winding, at most two faces at an edge, one fan of faces
///              at a vertex
///
/// Each component is wound consistently, then turned as a whole:
///  - closed: outward (positive signed volume). Exception: a component that is consistently wound,
///    faces inward and lies inside another closed component is a cavity and stays as it is. The
///    search for what it lies in gives up after some 10^9 steps, and then it is turned outward.
///  - open, or without volume: as the majority of its faces in the input; on a tie, as its lowest
///    face.
///  - one-sided (Moebius strip, Klein bottle): replaced by its two-sided double cover. Each face is
///    there twice, once in each direction, and walking once around the strip leads from one side to
///    the other. The limit surface, its boundary curve and lifting are exactly those of the
///    one-sided surface, without any seam: a cut would leave notches where it meets the boundary.
///    Normals have no global sign there and cancel in sums over both sides; a caller that wants one
///    side of everything skips what descends from faces `secondSide` and up.
///
/// Canonical form: every face starts at its lowest vertex. So rotating faces of the input, or
/// flipping any of them, changes not one bit of the output, except where the winding of the input
/// decides: which majority, and cavities. Faces and points keep their order; those of second sides
/// follow at the end.
///
/// @throws LimitError  a double cover would have 2^32 - 1 corners or more
/// Cost O(C log C) besides the search for cavities. Source: paper section 8.
PolygonMesh orient(PolygonMesh mesh, OrientReport& report);

}  // namespace vox
