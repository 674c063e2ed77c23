#pragma once

#include "libvox/core/origins.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/smoothing_options.h"
#include "libvox/prepare/convex_faces.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vox {

struct RepairOptions {
  /// Distance in world units; 0 welds only points with equal coordinates (-0 equals +0), and
  /// stitches vertices that miss an edge by rounding alone (stitch.h).
  double weldTolerance = 0;
  /// false: points at the same place stay separate, and nothing is stitched. Needed for results of
  /// repair, whose copies lie at the same place as their originals.
  bool weld = true;
  FaceRule faces = FaceRule::kSplit;  ///< whether concave faces are split
  /// Whether star-shaped faces are split, too, if they are not convex. Needed at sharp edges: there
  /// the image of a corner may lie outside of a notch.
  bool allConvex = false;
  /// Whether vertices that no face of the input uses are noted in the report. They are removed.
  bool noteUnused = true;
};

/// Kinds of changes that repair makes.
enum class RepairKind {
  kWeldedVertex,       ///< a vertex replaced by one at (nearly) the same place
  kStitchedVertex,     ///< a boundary vertex that entered a face on whose edge it lies
  kRepeatedCorner,     ///< a face that lost repeats (v v) and spikes (a b a)
  kSplitFace,          ///< a face that touched itself, cut into loops
  kDegenerateFace,     ///< a face without three distinct vertices, dropped
  kDuplicateFace,      ///< a face on the vertices of an earlier one, in either direction, dropped
  kCutEdge,            ///< an edge of three or more faces, cut into sheets
  kSplitVertex,        ///< a vertex between several fans: a copy for each fan but the first
  kChordedVertex,      ///< an interior vertex of two faces, removed from both
  kCollapsedFace,      ///< a face with two corners left after chording, dropped
  kVanishedComponent,  ///< a component of which chording left no face
  kRemovedVertex,      ///< a vertex without a face in the end, removed
};
inline constexpr std::size_t kRepairKindCount = 12;

/// Short name for JSON, such as "welded vertices".
std::string repairName(RepairKind kind);

/// All changes of one kind.
struct RepairAction {
  std::size_t count = 0;
  Index element = kNone;  ///< of the first change: a face or vertex of the input (kCutEdge: a face)
  std::string message;    ///< of the first change, numbers from 0: "welded vertex 7 to vertex 3"
};

/// Changes that repair made, and origins of the elements of its output.
struct RepairReport {
  std::array<RepairAction, kRepairKindCount> actions;
  FaceSplitReport faces;  ///< split faces: no change in the sense of changed()
  Origins pointOrigin;    ///< input point of each point of the output
  Origins faceOrigin;     ///< input face of each face of the output
  Adjacency joints;       ///< joined edges of the output, as joinFaces finds them
  Origins weldedTo;       ///< for each input point, the one it was welded to, or itself

  const RepairAction& operator[](RepairKind kind) const {
    return actions[static_cast<std::size_t>(kind)];
  }
  bool changed() const;  ///< whether there was any change
};

/// Summary in one line: "welded 403 vertices, cut 3 edges"; empty if there was no change.
std::string summary(const RepairReport& report);

/// Repairs a mesh so that orient() and then subdivision accept it: every edge has one or two faces;
/// each face has distinct vertices and occurs once; the faces around each vertex form one fan;
/// every vertex has a face; no interior vertex has only two. The output may be empty.
///
/// Steps, each described at its function:
///  1. weld (weld.h);
///  2. clean each face: in a walk around it, each return to a vertex closes a loop; loops of three
///     corners or more become faces, shorter ones (repeats, spikes, bridges) are dropped. If loops
///     lie in each other, as in a keyhole, the face is split into convex faces that leave the holes
///     free (convex_faces.h);
///  3. drop duplicate faces: the first one stays; stitch T-junctions (stitch.h); then split
///     concave faces, those that are not star-shaped (star_shaped.h), into convex ones, if the
///     options say so;
///  4. cut edges of three or more faces into sheets, and vertices into one copy per fan
///     (manifold.h);
///  5. chord interior vertices of two faces (chord.h), and repeat from 3 while that is needed;
///  6. remove unused vertices.
/// Faces without area but with three distinct vertices stay: Doo-Sabin can deal with them, and they
/// connect their neighbours.
///
/// Colours are dropped; soundMesh (sound.h) keeps them. Vertices and faces keep their order, unless
/// a large mesh has none (isScattered): then it is put into spatial order after step 2. Copies
/// follow at the end, in the order of their originals. A face starts at its lowest vertex. The
/// winding of faces does not matter. Copies lie at the place of their original, so a second run
/// that neither welds nor splits changes nothing.
///
/// @throws MeshError   the arrays are not valid (requireValidArrays)
/// @throws UsageError  the tolerance is negative or not finite
/// @throws LimitError  more than 2^32 - 2 points would be needed
/// Cost O(C log C) for any mesh. Parallel in part; result independent of thread count.
PolygonMesh repair(PolygonMesh mesh, const RepairOptions& options, RepairReport& report);

/// The same, if requireValidArrays has accepted the mesh.
PolygonMesh repairValid(PolygonMesh mesh, const RepairOptions& options, RepairReport& report);

}  // namespace vox
