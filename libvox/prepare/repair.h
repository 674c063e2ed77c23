#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vox {

struct RepairOptions {
  /// World units; 0 welds points of equal coordinates only (-0 equals +0).
  double weldTolerance = 0;
  /// false: points that lie on each other stay apart, as in what repair itself returns.
  bool weld = true;
};

/// What repair does to a mesh.
enum class RepairKind {
  kWeldedVertex,       ///< a vertex replaced by one at (nearly) the same place
  kRepeatedCorner,     ///< a face that lost repeats (v v) and spikes (a b a)
  kSplitFace,          ///< a face that touched itself, cut into its loops
  kDegenerateFace,     ///< a face without three distinct vertices, dropped
  kDuplicateFace,      ///< a face on the vertices of an earlier one, in either direction, dropped
  kCutEdge,            ///< an edge of three or more faces, cut into sheets
  kSplitVertex,        ///< a vertex between several fans: a copy for each fan but the first
  kChordedVertex,      ///< an interior vertex of two faces, removed from both
  kCollapsedFace,      ///< a face that chording left with two corners, closed up
  kVanishedComponent,  ///< a component that chording closed up altogether
  kRemovedVertex,      ///< a vertex no face names, in the input or after the rest, removed
};
inline constexpr std::size_t kRepairKindCount = 11;

/// Short name for JSON: "welded vertices".
std::string repairName(RepairKind kind);

/// All that was done of one kind.
struct RepairAction {
  std::size_t count = 0;
  Index element = kNone;  ///< the first one: a face or vertex of the input (kCutEdge: a face)
  std::string message;    ///< names it by its 0-based number: "welded vertex 7 to vertex 3"
};

/// What repair did, and where its output comes from.
struct RepairReport {
  std::array<RepairAction, kRepairKindCount> actions;
  std::vector<Index> pointOrigin;  ///< input point of each point of the output
  std::vector<Index> faceOrigin;   ///< input face of each face of the output
  std::vector<Index> weldedTo;     ///< per input point: the input point it was welded to, or itself

  const RepairAction& operator[](RepairKind kind) const {
    return actions[static_cast<std::size_t>(kind)];
  }
  bool changed() const;  ///< whether anything was done at all
};

/// One line: "welded 403 vertices, cut 3 edges"; empty if nothing was done.
std::string summary(const RepairReport& report);

/// A mesh that needs nothing but orient() to be subdivided: every edge has one face or two, faces
/// have distinct vertices and none is there twice, the faces around each vertex form one fan, every
/// vertex has a face, and no interior vertex has only two. The output may be empty.
///
/// Steps, each described at its function:
///  1. weld (weld.h);
///  2. clean each face: walking it, each return to a vertex closes a loop; loops of three corners
///     or more become faces, shorter ones (repeats, spikes) vanish. A keyhole face becomes its
///     outline and a lid on its hole;
///  3. drop duplicate faces: the first one stays;
///  4. cut edges of three or more faces into sheets, and vertices into one copy per fan
///     (manifold.h);
///  5. chord interior vertices of two faces (chord.h), and repeat from 3 while that is needed;
///  6. remove unused vertices.
/// Faces without area but with three distinct vertices stay: they are harmless to Doo-Sabin, and
/// what hangs together through them stays together.
///
/// Colours are dropped: soundMesh (sound.h) follows them. Vertices and faces keep their order;
/// copies follow at the end, in order of the vertices they copy. A face that needs nothing keeps
/// its corners as they are. Winding is never looked at. Copies lie where their original lies, so a
/// second run changes nothing if it does not weld.
///
/// @throws MeshError   the arrays contradict themselves (requireValidArrays)
/// @throws UsageError  the tolerance is negative or not finite
/// @throws LimitError  more than 2^32 - 2 points would be needed
/// Cost O(C log C) whatever the mesh; parallel in part, result independent of thread count.
PolygonMesh repair(PolygonMesh mesh, const RepairOptions& options, RepairReport& report);

}  // namespace vox
