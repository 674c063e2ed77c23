// The order of the steps, and the origins of all elements, so that messages can name elements of
// the input.

#include "libvox/prepare/repair.h"

#include "libvox/core/parallel.h"
#include "libvox/mesh/spatial_order.h"
#include "libvox/mesh/star_shaped.h"
#include "libvox/mesh/validate.h"
#include "libvox/prepare/chord.h"
#include "libvox/prepare/face_order.h"
#include "libvox/prepare/loop_cutter.h"
#include "libvox/prepare/manifold.h"
#include "libvox/prepare/stitch.h"
#include "libvox/prepare/weld.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>

namespace vox {
namespace {

/// Chording can create edges of four faces; cutting these can create new vertices to chord. Real
/// meshes need one or two rounds. The limit bounds the cost for all others.
constexpr int kMostRounds = 16;

std::string str(std::size_t n) {
  return std::to_string(n);
}

/// The mesh between two steps, and the elements of the input from which its elements come.
struct Draft {
  PolygonMesh mesh;
  Origins pointOrigin;
  Origins faceOrigin;
  std::vector<bool> dispensable;  // per input point: not missed if the output lacks it
};

template <class Message>
void note(RepairReport& report, RepairKind kind, Index element, Message&& message) {
  RepairAction& action = report.actions[static_cast<std::size_t>(kind)];
  if (action.count++ > 0) return;
  action.element = element;
  action.message = message();
}

/// For each point, whether a face uses it.
std::vector<std::uint8_t> usedPoints(const PolygonMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.pointCount(), 0);
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    std::atomic_ref<std::uint8_t> mark(used[mesh.faceVertices[c]]);
    if (mark.load(std::memory_order_relaxed) == 0) mark.store(1, std::memory_order_relaxed);
  });
  return used;
}

void weld(Draft& draft, double tolerance, RepairReport& report) {
  report.weldedTo = weldTargets(draft.mesh.points, usedPoints(draft.mesh), tolerance);
  const Origins& weldedTo = report.weldedTo;
  if (weldedTo.areTheSame()) return;
  const Index count = draft.mesh.pointCount();
  const Index first =
      lowestWhere(count, kElementsPerTask, [&](Index v) { return weldedTo[v] != v; });
  if (first == count) return;
  for (Index v = first; v < count; ++v)
    if (weldedTo[v] != v)
      note(report, RepairKind::kWeldedVertex, v,
           [&] { return "welded vertex " + str(v) + " to vertex " + str(weldedTo[v]); });
  parallelForEach(draft.mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    draft.mesh.faceVertices[c] = weldedTo[draft.mesh.faceVertices[c]];
  });
}

void noteCleaning(Index f, Index loops, bool repeats, RepairReport& report) {
  if (loops == 0)
    note(report, RepairKind::kDegenerateFace, f,
         [&] { return "dropped face " + str(f) + ", which has fewer than 3 distinct corners"; });
  else if (repeats)
    note(report, RepairKind::kRepeatedCorner, f,
         [&] { return "removed repeated corners from face " + str(f); });
  if (loops > 1)
    note(report, RepairKind::kSplitFace, f, [&] {
      return "split face " + str(f) + ", which touches itself, into " + str(loops) + " faces";
    });
}

void countSplit(FaceSplit& split, Index f, std::size_t parts) {
  if (split.faces++ == 0) split.first = f;
  split.parts += parts;
}

/// Whether a face has a vertex twice.
bool hasRepeats(std::span<const Index> face) {
  constexpr std::size_t kFew = 16;
  if (face.size() > kFew) {
    std::vector<Index> sorted(face.begin(), face.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  }
  for (std::size_t i = 1; i < face.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (face[i] == face[j]) return true;
  return false;
}

void cleanFaces(Draft& draft, RepairReport& report) {
  const Index faces = draft.mesh.faceCount();
  const auto mustBeCleaned = [&](Index f) { return hasRepeats(draft.mesh.face(f)); };
  if (lowestWhere(faces, kElementsPerTask, mustBeCleaned) == faces) return;
  PolygonMesh clean;
  std::vector<Index> faceOrigin;
  LoopCutter cutter(draft.mesh.pointCount());
  std::vector<std::vector<Index>> loops;
  std::vector<std::vector<Index>> parts;
  for (Index f = 0; f < draft.mesh.faceCount(); ++f) {
    loops.clear();
    bool repeats = false;
    cutter.cut(draft.mesh.face(f), [&](std::span<const Index> loop) {
      repeats |= loop.size() < 3;
      if (loop.size() >= 3) loops.emplace_back(loop.begin(), loop.end());
    });
    const Index origin = draft.faceOrigin[f];
    const bool isKeyhole = loops.size() > 1 && convexFaces(draft.mesh.points, loops, parts);
    if (isKeyhole) {
      countSplit(report.faces.keyholes, origin, parts.size());
      for (const Index v : draft.mesh.face(f)) draft.dispensable[v] = true;  // those on bridges
    } else {
      noteCleaning(origin, static_cast<Index>(loops.size()), repeats, report);
    }
    for (const std::vector<Index>& face : isKeyhole ? parts : loops) {
      clean.addFace(face);
      faceOrigin.push_back(origin);
    }
  }
  clean.points = std::move(draft.mesh.points);
  draft.mesh = std::move(clean);
  draft.faceOrigin = std::move(faceOrigin);
}

/// Whether there may be duplicate faces. Each edge of such a face has three faces or more, or its
/// two faces are the duplicates.
bool mayHaveDuplicates(const PolygonMesh& mesh, const Joints& joints) {
  if (!joints.crowdedEdges.empty()) return true;
  const auto& [twin, cornerFace] = joints.adjacency;
  const auto hasOneNeighbour = [&](Index f) {
    const Index first = twin[mesh.faceOffsets[f]];
    if (first == kNone) return false;
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c)
      if (twin[c] == kNone || cornerFace[twin[c]] != cornerFace[first]) return false;
    return true;
  };
  return lowestWhere(mesh.faceCount(), kElementsPerTask, hasOneNeighbour) < mesh.faceCount();
}

/// @return whether there were duplicate faces
bool dropDuplicates(Draft& draft, RepairReport& report) {
  const std::vector<Index> first = firstAlike(draft.mesh);
  PolygonMesh kept;
  std::vector<Index> faceOrigin;
  for (Index f = 0; f < draft.mesh.faceCount(); ++f) {
    const Index origin = draft.faceOrigin[f];
    if (first[f] == f) {
      kept.addFace(draft.mesh.face(f));
      faceOrigin.push_back(origin);
      continue;
    }
    note(report, RepairKind::kDuplicateFace, origin, [&] {
      return "dropped face " + str(origin) + ", which repeats face " +
             str(draft.faceOrigin[first[f]]);
    });
  }
  const bool dropped = kept.faceCount() < draft.mesh.faceCount();
  kept.points = std::move(draft.mesh.points);
  draft.mesh = std::move(kept);
  draft.faceOrigin = std::move(faceOrigin);
  return dropped;
}

/// Joins the faces, without duplicates.
Joints joinDistinctFaces(Draft& draft, RepairReport& report) {
  startFacesAtLowest(draft.mesh);
  Joints joints = joinFaces(draft.mesh, CrowdedEdge::kPairSheets);
  if (!mayHaveDuplicates(draft.mesh, joints) || !dropDuplicates(draft, report)) return joints;
  return joinFaces(draft.mesh, CrowdedEdge::kPairSheets);
}

/// For each face, whether it is to be split: it is not star-shaped, or not convex. Parallel.
std::vector<std::uint8_t> concaveFaces(const PolygonMesh& mesh, bool allConvex) {
  constexpr Index kTestsPerTask = 2048;
  std::vector<std::uint8_t> concave(mesh.faceCount());
  parallelForEach(mesh.faceCount(), kTestsPerTask, [&](Index f) {
    if (mesh.faceSize(f) == 3) return;
    std::vector<Index> face(mesh.face(f).begin(), mesh.face(f).end());
    canonicalize(face);  // sums of other orders might decide otherwise
    std::vector<Vec3d> corners;
    for (const Index v : face) corners.push_back(mesh.points[v]);
    concave[f] = !(allConvex ? isConvex(corners) : isStarShaped(corners));
  });
  return concave;
}

/// @return whether there were concave faces
bool splitConcaveFaces(Draft& draft, bool allConvex, RepairReport& report) {
  if (draft.mesh.cornerCount() == std::size_t{3} * draft.mesh.faceCount()) return false;
  const std::vector<std::uint8_t> concave = concaveFaces(draft.mesh, allConvex);
  if (std::find(concave.begin(), concave.end(), 1) == concave.end()) return false;
  PolygonMesh split;
  std::vector<Index> faceOrigin;
  std::vector<std::vector<Index>> parts;
  for (Index f = 0; f < draft.mesh.faceCount(); ++f) {
    const std::vector<Index> face(draft.mesh.face(f).begin(), draft.mesh.face(f).end());
    if (!concave[f] || !convexFaces(draft.mesh.points, {&face, 1}, parts)) parts = {face};
    if (parts.size() > 1) countSplit(report.faces.concave, draft.faceOrigin[f], parts.size());
    for (const std::vector<Index>& part : parts) {
      split.addFace(part);
      faceOrigin.push_back(draft.faceOrigin[f]);
    }
  }
  split.points = std::move(draft.mesh.points);
  draft.mesh = std::move(split);
  draft.faceOrigin = std::move(faceOrigin);
  return true;
}

/// Puts the points and the faces of a scattered mesh into spatial order, so that those which are
/// used together are near in memory.
void putInOrder(Draft& draft) {
  if (!isScattered(draft.mesh)) return;
  const PolygonMesh old = std::exchange(draft.mesh, {});
  PolygonMesh& mesh = draft.mesh;
  std::vector<Index> points = spatialOrder(old.points);
  std::vector<Index> newName(points.size());
  mesh.points.resize(points.size());
  parallelForEach(static_cast<Index>(points.size()), kElementsPerTask, [&](Index v) {
    newName[points[v]] = v;
    mesh.points[v] = old.points[points[v]];
  });
  const auto lowestOf = [&](Index f) {
    Index lowest = kNone;
    for (const Index v : old.face(f)) lowest = std::min(lowest, newName[v]);
    return lowest;
  };
  std::vector<std::pair<Index, Index>> faces(old.faceCount());  // lowest vertex, number
  parallelForEach(old.faceCount(), kElementsPerTask, [&](Index f) { faces[f] = {lowestOf(f), f}; });
  parallelSort(faces);
  mesh.faceOffsets.reserve(old.faceOffsets.size());
  for (const auto& [lowest, f] : faces)
    mesh.faceOffsets.push_back(mesh.faceOffsets.back() + old.faceSize(f));
  mesh.faceVertices.resize(old.faceVertices.size());
  parallelForEach(old.faceCount(), kElementsPerTask, [&](Index g) {
    Index c = mesh.faceOffsets[g];
    for (const Index v : old.face(faces[g].second)) mesh.faceVertices[c++] = newName[v];
  });
  draft.pointOrigin = composed(draft.pointOrigin, std::move(points));
  std::vector<Index> order;
  order.reserve(faces.size());
  for (const auto& [lowest, f] : faces) order.push_back(f);
  draft.faceOrigin = composed(draft.faceOrigin, std::move(order));
}

std::pair<Index, Index> edgeOf(const Draft& draft, const Adjacency& joints, Index c) {
  return {draft.mesh.faceVertices[c], draft.mesh.faceVertices[nextCorner(draft.mesh, joints, c)]};
}

void noteStitches(const Draft& draft, const Adjacency& joints, const std::vector<EdgeVertex>& added,
                  RepairReport& report) {
  for (const auto& [corner, vertex] : added) {
    const Index origin = draft.pointOrigin[vertex];
    note(report, RepairKind::kStitchedVertex, origin, [&, corner = corner] {
      const auto [v, w] = edgeOf(draft, joints, corner);
      return "stitched vertex " + str(origin) + " into face " +
             str(draft.faceOrigin[joints.cornerFace[corner]]) + ", on whose edge (" +
             str(draft.pointOrigin[v]) + ", " + str(draft.pointOrigin[w]) + ") it lies";
    });
  }
}

/// Stitches T-junctions. Parts of edges may have further vertices within the tolerance.
/// @param joints  of the draft; those of the result are returned
Joints stitch(Draft& draft, Joints joints, double tolerance, RepairReport& report) {
  constexpr int kMostPasses = 4;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const auto added = verticesOnEdges(draft.mesh, joints, tolerance);
    if (added.empty()) break;
    noteStitches(draft, joints.adjacency, added, report);
    draft.mesh = withEdgeVertices(draft.mesh, added);
    cleanFaces(draft, report);
    joints = joinDistinctFaces(draft, report);
  }
  return joints;
}

void noteCutEdges(const Draft& draft, const Joints& joints, RepairReport& report) {
  for (const Index c : joints.crowdedEdges) {
    const auto [v, w] = edgeOf(draft, joints.adjacency, c);
    const auto [low, high] = std::minmax({draft.pointOrigin[v], draft.pointOrigin[w]});
    const Index face = draft.faceOrigin[joints.adjacency.cornerFace[c]];
    note(report, RepairKind::kCutEdge, face, [&, low = low, high = high] {
      return "cut edge (" + str(low) + ", " + str(high) + ") of face " + str(face) +
             ", which has three faces or more";
    });
  }
}

/// For each vertex of the draft, whether it belongs to a crowded edge.
std::vector<bool> crowdedVertices(const Draft& draft, const Joints& joints) {
  std::vector<bool> crowded(draft.mesh.pointCount(), false);
  for (const Index c : joints.crowdedEdges) {
    const auto [v, w] = edgeOf(draft, joints.adjacency, c);
    crowded[v] = crowded[w] = true;
  }
  return crowded;
}

void noteCopies(Draft& draft, const std::vector<Index>& copied, const std::vector<bool>& atCut,
                RepairReport& report) {
  for (const Index v : copied) {
    const Index origin = draft.pointOrigin[v];
    draft.pointOrigin.add(origin);
    if (atCut[v]) continue;
    note(report, RepairKind::kSplitVertex, origin,
         [&] { return "split vertex " + str(origin) + ", which joins several fans of faces"; });
  }
}

/// Cuts the mesh so that every edge has one or two faces and every vertex one fan. If the fans of
/// two pairs of sheets meet again around both ends of their edge, the copies of vertices do not
/// separate the pairs. A second pass then joins no faces at the edge, which leaves at most two
/// faces at each copy of it.
/// @param joints  of the draft, in pairs of sheets
Adjacency cutIntoSheets(Draft& draft, Joints joints, RepairReport& report) {
  noteCutEdges(draft, joints, report);
  for (int pass = 0; pass < 2; ++pass) {
    const auto atCut = crowdedVertices(draft, joints);
    const auto copied = splitFans(draft.mesh, joints.adjacency);
    noteCopies(draft, copied, atCut, report);
    if (joints.crowdedEdges.empty()) break;
    joints = joinFaces(draft.mesh, CrowdedEdge::kSeparate);
  }
  return std::move(joints.adjacency);
}

void noteChords(Draft& draft, const ChordResult& chords, RepairReport& report) {
  for (const Index v : chords.chordedVertices) {
    draft.dispensable[draft.pointOrigin[v]] = true;
    note(report, RepairKind::kChordedVertex, draft.pointOrigin[v], [&] {
      return "chorded vertex " + str(draft.pointOrigin[v]) +
             ", which has only two faces and no boundary";
    });
  }
  for (const Index f : chords.collapsedFaces)
    note(report, RepairKind::kCollapsedFace, draft.faceOrigin[f], [&] {
      return "closed up face " + str(draft.faceOrigin[f]) + ", which chords left with two corners";
    });
  for (const Index f : chords.vanishedComponents)
    note(report, RepairKind::kVanishedComponent, draft.faceOrigin[f], [&] {
      return "dropped the component of face " + str(draft.faceOrigin[f]) +
             ", which encloses nothing";
    });
}

/// @return whether any vertex was chorded
bool chord(Draft& draft, const Adjacency& joints, RepairReport& report) {
  if (!hasInteriorPair(draft.mesh, joints)) return false;
  ChordResult chords = chordInteriorPairs(draft.mesh, joints);
  noteChords(draft, chords, report);
  draft.mesh = std::move(chords.mesh);
  draft.faceOrigin = composed(draft.faceOrigin, std::move(chords.faceOrigin));
  return true;
}

/// Joins the faces of a mesh that has been cut. Copies of vertices have higher numbers, so other
/// vertices of their faces may be the lowest now.
Adjacency joinedAgain(PolygonMesh& mesh) {
  startFacesAtLowest(mesh);
  return joinFaces(mesh, CrowdedEdge::kSeparate).adjacency;
}

/// Chording can leave concave faces, and splitting can end at vertices of two faces. So both are
/// done in each round.
/// @return  the joints of the result
Adjacency makeManifold(Draft& draft, const RepairOptions& options, RepairReport& report) {
  Joints sheets = joinDistinctFaces(draft, report);
  if (options.weld) sheets = stitch(draft, std::move(sheets), options.weldTolerance, report);
  for (int round = 0; round < kMostRounds; ++round) {
    if (options.faces == FaceRule::kSplit && splitConcaveFaces(draft, options.allConvex, report))
      sheets = joinDistinctFaces(draft, report);
    const std::size_t pointsBefore = draft.mesh.points.size();
    const bool wasCrowded = !sheets.crowdedEdges.empty();
    Adjacency joints = cutIntoSheets(draft, std::move(sheets), report);
    if (!chord(draft, joints, report)) {
      const bool isAsJoined = !wasCrowded && draft.mesh.points.size() == pointsBefore;
      return isAsJoined ? std::move(joints) : joinedAgain(draft.mesh);
    }
    sheets = joinDistinctFaces(draft, report);
  }
  Adjacency joints = cutIntoSheets(draft, std::move(sheets), report);
  openInteriorPairs(draft.mesh, joints);
  const auto copied = splitFans(draft.mesh, joints);
  noteCopies(draft, copied, std::vector<bool>(draft.mesh.pointCount(), false), report);
  return joinedAgain(draft.mesh);
}

/// Counts the vertices of the input that are not in the output, except welded and chorded ones, and
/// those on bridges of keyholes.
void noteRemoved(const Draft& draft, RepairReport& report) {
  const Origins& origins = draft.pointOrigin;
  if (origins.areTheSame() && origins.size() == draft.dispensable.size()) return;
  std::vector<bool> accountedFor = draft.dispensable;
  for (Index v = 0; v < origins.size(); ++v) accountedFor[origins[v]] = true;
  for (Index v = 0; v < accountedFor.size(); ++v)
    if (!accountedFor[v] && report.weldedTo[v] == v)
      note(report, RepairKind::kRemovedVertex, v,
           [&] { return "removed vertex " + str(v) + ", which belongs to no face"; });
}

void removeUnused(Draft& draft) {
  const std::vector<std::uint8_t> used = usedPoints(draft.mesh);
  if (std::find(used.begin(), used.end(), 0) == used.end()) return;
  std::vector<Index> newName(draft.mesh.pointCount(), kNone);
  std::vector<Index> kept;
  for (Index v = 0; v < newName.size(); ++v) {
    if (!used[v]) continue;
    newName[v] = static_cast<Index>(kept.size());
    draft.mesh.points[kept.size()] = draft.mesh.points[v];
    kept.push_back(v);
  }
  draft.mesh.points.resize(kept.size());
  draft.pointOrigin = composed(draft.pointOrigin, std::move(kept));
  for (Index& v : draft.mesh.faceVertices) v = newName[v];
}

}  // namespace

PolygonMesh repair(PolygonMesh mesh, const RepairOptions& options, RepairReport& report) {
  requireValidArrays(mesh);
  return repairValid(std::move(mesh), options, report);
}

PolygonMesh repairValid(PolygonMesh mesh, const RepairOptions& options, RepairReport& report) {
  mesh.pointColors.clear();
  mesh.faceColors.clear();
  mesh.faceGroups.clear();
  mesh.attributes = {};
  report = RepairReport{};
  report.weldedTo = Origins(mesh.pointCount());
  Draft draft{std::move(mesh), {}, {}, {}};
  draft.dispensable.assign(draft.mesh.pointCount(), false);
  draft.pointOrigin = Origins(draft.mesh.pointCount());
  draft.faceOrigin = Origins(draft.mesh.faceCount());

  if (options.weld) weld(draft, options.weldTolerance, report);
  cleanFaces(draft, report);
  putInOrder(draft);
  report.joints = makeManifold(draft, options, report);
  removeUnused(draft);
  if (options.noteUnused) noteRemoved(draft, report);
  report.pointOrigin = std::move(draft.pointOrigin);
  report.faceOrigin = std::move(draft.faceOrigin);
  return std::move(draft.mesh);
}

}  // namespace vox
