// Subdivision of the objects of a scene within a memory budget.

#include "libvox/pipeline/refine.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/mesh/validate.h"
#include "libvox/pipeline/work.h"
#include "libvox/prepare/corner_origin.h"
#include "libvox/prepare/debris.h"
#include "libvox/prepare/gaps.h"
#include "libvox/prepare/sound.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// Adds the names of file and object to mesh errors.
template <class Work>
auto namingObject(const Scene& scene, const SceneObject& object, Work&& work) {
  try {
    return work();
  } catch (const MeshError& error) {
    std::string where;
    if (!scene.files.empty()) where += scene.files[0].string() + ": ";
    if (scene.objects.size() > 1) where += object.name + ": ";
    throw MeshError(where + error.what() + " (elements are counted from 0)");
  }
}

/// The elements of the input that those of a prepared mesh come from.
struct ElementOrigin {
  Origins weldedTo;  ///< for each input vertex: the one that it was welded to, or itself
  Origins points;    ///< for each prepared vertex: an input vertex, or kNone
  Origins faces;     ///< for each prepared face: an input face
};

/// Warns of what reading the file of an object has lost. Strict: refuses a file that is odd at all.
void noteReading(const SceneObject& object, bool strict, std::vector<std::string>& warnings) {
  const std::string odd = firstOddity(object.reading);
  if (strict && !odd.empty()) throw InputError(odd + ", which --strict forbids");
  const std::string lost = lossText(object.reading);
  if (!lost.empty()) warnings.push_back(object.name + ": reading its file " + lost);
}

RepairOptions repairOptionsOf(const ObjectPreparation& preparation) {
  RepairOptions repair;
  repair.weldTolerance = preparation.weldTolerance;
  repair.faces = preparation.faces;
  repair.allConvex = preparation.mayCrease();
  repair.noteUnused = preparation.dropComponents.dropsNothing();  // dropped faces leave vertices
  return repair;
}

/// The mesh of an object without debris, groups and attributes.
/// @param usedUp  as in prepare
/// @throws MeshError  nothing is left
PolygonMesh keptMeshOf(const SceneObject& object, const ObjectPreparation& preparation,
                       DebrisReport& report, PolygonMesh* usedUp = nullptr) {
  if (preparation.dropComponents.dropsNothing()) {
    PolygonMesh mesh;
    if (usedUp != nullptr) {
      mesh.points = std::move(usedUp->points);
      mesh.faceOffsets = std::move(usedUp->faceOffsets);
      mesh.faceVertices = std::move(usedUp->faceVertices);
      mesh.pointColors = std::move(usedUp->pointColors);
      mesh.faceColors = std::move(usedUp->faceColors);
      return mesh;
    }
    mesh.points = object.mesh.points;
    mesh.faceOffsets = object.mesh.faceOffsets;
    mesh.faceVertices = object.mesh.faceVertices;
    mesh.pointColors = object.mesh.pointColors;
    mesh.faceColors = object.mesh.faceColors;
    return mesh;
  }
  PolygonMesh kept =
      withoutDebris(object.mesh, preparation.dropComponents, repairOptionsOf(preparation), report);
  if (kept.faceCount() == 0)
    throw MeshError(
        (report.components == 1 ? std::string("the only component would be dropped; it has ")
                                : "all " + std::to_string(report.components) +
                                      " components would be dropped; the largest has ") +
        std::to_string(report.mostFaces) + (report.mostFaces == 1 ? " face" : " faces") +
        " and a box whose diagonal is " + exactNumber(report.largestDiagonal) +
        "; lower the limits of --drop-components");
  return kept;
}

/// The mesh of an object made sound, and its adjacency; a warning tells what was done to it.
PolygonMesh soundMeshOf(const SceneObject& object, const ObjectPreparation& preparation,
                        PolygonMesh* usedUp, ElementOrigin& origin, Adjacency& adjacency,
                        std::vector<std::string>& warnings) {
  DebrisReport debris;
  SoundReport report;
  PolygonMesh mesh = soundMesh(keptMeshOf(object, preparation, debris, usedUp),
                               repairOptionsOf(preparation), report);
  std::string done = summary(report);
  if (preparation.strict && !done.empty())
    throw MeshError("needs repair, which --strict forbids: " + firstAction(report) +
                    "; in all: " + done);
  if (mesh.faceCount() == 0)
    throw MeshError("nothing is left after repair: " + done +
                    (preparation.weldTolerance > 0 ? "; use a smaller --weld" : ""));
  if (debris.dropped > 0) warnings.push_back(object.name + ": " + summary(debris));
  const std::string split = summary(report.repair.faces);
  if (!split.empty()) done += (done.empty() ? "" : ", ") + split;
  if (!done.empty()) warnings.push_back(object.name + ": " + done);
  origin.weldedTo = std::move(report.repair.weldedTo);
  origin.points = std::move(report.orient.pointOrigin);
  origin.faces = std::move(report.orient.faceOrigin);
  adjacency = std::move(report.orient.adjacency);
  if (!debris.keptFaces.empty()) origin.faces = composed(debris.keptFaces, origin.faces);
  return mesh;
}

/// Warns that an object lacks what should be sharp. Strict: refuses it.
void noteMissing(const std::string& what, const SceneObject& object, bool strict,
                 std::vector<std::string>& warnings) {
  if (strict) throw MeshError(what + ", which --strict forbids");
  warnings.push_back(object.name + ": " + what);
}

/// The edges and vertices that stay sharp. A warning tells of edges that are none.
SharpFeatures sharpFeaturesOf(const SceneObject& object, const ObjectPreparation& preparation,
                              const PolygonMesh& mesh, const Adjacency& adjacency,
                              const ElementOrigin& origin, std::vector<std::string>& warnings) {
  const InputElements input{origin.weldedTo, origin.points, origin.faces};
  SharpFeatures sharp = nothingSharp(mesh);
  if (preparation.crease.degrees)
    markByAngle(mesh, adjacency, input, *preparation.crease.degrees, sharp);
  if (preparation.crease.groups && object.mesh.faceGroups.empty())
    noteMissing("has no smoothing groups, so no edge is sharp by group", object, preparation.strict,
                warnings);
  else if (preparation.crease.groups)
    markByGroups(adjacency, input, object.mesh.faceGroups, sharp);
  const std::vector<std::size_t> missing =
      markByPoints(mesh, adjacency, input, preparation.creaseEdges, sharp);
  if (!missing.empty()) {
    const PointPair& first = preparation.creaseEdges[missing[0]];
    noteMissing("the mesh has no edge at " + std::to_string(missing.size()) + " of the " +
                    std::to_string(preparation.creaseEdges.size()) +
                    " pairs of vertices of --crease-edges; the first is " +
                    std::to_string(first[0]) + " " + std::to_string(first[1]) + ", counted from 0",
                object, preparation.strict, warnings);
  }
  markVertices(input, preparation.cornerVertices, sharp);
  if (preparation.boundary == BoundaryRule::kCorners) markBoundaryCorners(mesh, adjacency, sharp);
  return sharp;
}

/// The vertices of the prepared mesh that come from some input vertices, copies included.
std::vector<Index> verticesFrom(std::span<const Index> inputVertices, const ElementOrigin& origin) {
  std::vector<Index> wanted(origin.weldedTo.size(), kNone);
  for (const Index v : inputVertices) {
    if (v >= origin.weldedTo.size())
      throw MeshError("vertex " + std::to_string(v) +
                      " is to be interpolated, but there are only " +
                      std::to_string(origin.weldedTo.size()));
    wanted[origin.weldedTo[v]] = v;
  }
  std::vector<Index> found;
  std::vector<bool> seen(wanted.size(), false);
  for (Index v = 0; v < origin.points.size(); ++v) {
    const Index from = origin.points[v];
    if (from == kNone || wanted[from] == kNone) continue;
    found.push_back(v);
    seen[from] = true;
  }
  for (Index w = 0; w < wanted.size(); ++w)
    if (wanted[w] != kNone && !seen[w])
      throw MeshError("vertex " + std::to_string(wanted[w]) +
                      " is to be interpolated, but repair has removed it");
  return found;
}

/// Peak of interpolation: an image per corner, and the vectors of the solver.
std::uint64_t bytesOfInterpolation(const PolygonMesh& mesh) {
  constexpr std::uint64_t kPerCorner = sizeof(Vec3d) + sizeof(Index);
  constexpr std::uint64_t kPerVertex = 6 * sizeof(Vec3d) + 4 * sizeof(Index);
  return mesh.cornerCount() * kPerCorner + mesh.pointCount() * kPerVertex;
}

/// Share of step k in the work: every step makes four times as much as the step before.
double partOfStep(int k, int levels) {
  return 3 * std::ldexp(1.0, 2 * (k - 1)) / (std::ldexp(1.0, 2 * levels) - 1);
}

/// The colours of the points of the next level; none if the level has no colours. An image has the
/// colour of its face if points have none.
std::vector<Vec3f> imageColors(SubdivisionLevel& level) {
  PolygonMesh& mesh = level.mesh;
  std::vector<Vec3f> colors;
  if (!mesh.pointColors.empty()) {
    std::vector<Vec3d> asPoints;
    for (const Vec3f& color : mesh.pointColors) asPoints.push_back(color.cast<double>());
    std::swap(mesh.points, asPoints);
    for (const Vec3d& color : imageVertices(level))
      colors.push_back(color.cwiseMax(0).cwiseMin(1).cast<float>());
    std::swap(mesh.points, asPoints);
  } else if (!mesh.faceColors.empty()) {
    const auto colorAt = [&](Index c) { return mesh.faceColors[level.adjacency.cornerFace[c]]; };
    for (Index c = 0; c < mesh.cornerCount(); ++c) colors.push_back(colorAt(c));
    if (level.boundary == BoundaryStage::kExtend)
      for (const Index c : boundaryCorners(level.adjacency))
        colors.insert(colors.end(), 2, colorAt(c));
  }
  return colors;
}

/// Appends the colours of more elements to those of the first `count`. Elements without are grey.
void appendColors(std::vector<Vec3f>& all, Index count, std::vector<Vec3f> more, Index moreCount) {
  if (all.empty() && more.empty()) return;
  const Vec3f plain = Vec3f::Constant(kPlainColor);
  all.resize(count, plain);
  more.resize(moreCount, plain);
  all.insert(all.end(), more.begin(), more.end());
}

/// append (polygon_mesh.h) and the colours, if all elements fit in 32 bits.
void appendWithin(PolygonMesh& all, PolygonMesh part) {
  if (std::uint64_t{all.cornerCount()} + part.cornerCount() >= kNone ||
      std::uint64_t{all.pointCount()} + part.pointCount() >= kNone)
    throw LimitError("the objects together have more elements than fit in 32 bits");
  if (all.faceCount() == 0) {
    all = std::move(part);
    return;
  }
  appendColors(all.pointColors, all.pointCount(), std::move(part.pointColors), part.pointCount());
  appendColors(all.faceColors, all.faceCount(), std::move(part.faceColors), part.faceCount());
  append(all, part);
}

/// Work of the stages of an object.
struct RefineWork {
  double prepare;
  double subdivide;
  double write;
  RefineWork(const PolygonMesh& mesh, int levels, bool interpolates)
      : prepare(workOfPreparing(mesh, interpolates)),
        subdivide(kPerCorner * mesh.cornerCount() * std::ldexp(1.0, 2 * levels)),
        write(kWritingPerCorner * mesh.cornerCount() * std::ldexp(1.0, 2 * levels)) {}

 private:
  static constexpr double kPerCorner = 50;
  static constexpr double kWritingPerCorner = 200;
};

void prepareAll(const Scene& scene, int levels, std::span<const ObjectPreparation> preparations,
                MemoryBudget budget, Progress& progress, const VisitPrepared& visit) {
  std::vector<RefineWork> works;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    works.emplace_back(scene.objects[i].mesh, levels, preparations[i].interpolates());
    progress.plan(works[i].prepare + works[i].subdivide + works[i].write);
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    budget.take(bytesOf(object.mesh), "the input", kRefineAdvice);
    progress.begin("prepare", works[i].prepare);
    PreparedObject prepared = prepare(scene, object, preparations[i], budget, progress);
    progress.begin("subdivide", works[i].subdivide);
    visit(i, std::move(prepared), budget, progress);
  }
}

}  // namespace

std::uint64_t bytesOf(const PolygonMesh& mesh) {
  return mesh.points.size() * sizeof(Vec3d) +
         (mesh.faceOffsets.size() + mesh.faceVertices.size()) * sizeof(Index) +
         (mesh.pointColors.size() + mesh.faceColors.size()) * sizeof(Vec3f) +
         mesh.attributes.texcoords.size() * sizeof(Vec2f) +
         (mesh.attributes.objects.ofFaces.size() + mesh.attributes.groups.ofFaces.size() +
          mesh.attributes.materials.ofFaces.size()) *
             sizeof(Index);
}

std::uint64_t bytesOf(const SubdivisionLevel& level) {
  return bytesOf(level.mesh) + level.adjacency.twin.size() * sizeof(Index) +
         level.adjacency.cornerFace.bytes();
}

std::uint64_t bytesOfImage(const SubdivisionLevel& level) {
  return nextPointCount(level) * sizeof(Vec3d);
}

std::uint64_t bytesOfNextTopology(const SubdivisionLevel& level) {
  // Edge, ring, offset, slot per corner; offset and name per boundary corner.
  constexpr std::uint64_t kTables = 6 * sizeof(Index);
  constexpr std::uint64_t kCorner = 4 * sizeof(Index);  // vertex, twin, face; offsets, rounded up
  return level.mesh.cornerCount() * kTables + nextCornerCount(level) * kCorner;
}

SubdivisionLevel subdividedWithin(const MemoryBudget& budget, SubdivisionLevel level, int levels,
                                  Progress& progress, Colors colors,
                                  std::vector<VertexPlace>* places) {
  for (int k = 1; k <= levels; ++k) {
    progress.check();
    budget.require(bytesOf(level) + bytesOfImage(level) + bytesOfNextTopology(level),
                   "level " + std::to_string(k), kRefineAdvice);
    std::vector<Vec3f> painted;
    if (colors == Colors::kKept) painted = imageColors(level);
    if (places != nullptr) *places = nextPlaces(level, *places, k - 1);
    level = nextLevel(level, imageVertices(level));
    level.mesh.pointColors = std::move(painted);
    progress.done(partOfStep(k, levels));
  }
  return level;
}

void requireValidScene(const Scene& scene) {
  for (const SceneObject& object : scene.objects)
    namingObject(scene, object, [&] { requireValidArrays(object.mesh); });
}

Box keptBox(const Scene& scene, const SceneObject& object, const ObjectPreparation& preparation) {
  if (preparation.dropComponents.dropsNothing()) return usedBox(object.mesh);
  return namingObject(scene, object, [&] {
    DebrisReport unused;
    return usedBox(keptMeshOf(object, preparation, unused));
  });
}

std::string gapsOf(const SceneObject& object, const ObjectPreparation& preparation) {
  DebrisReport unused;
  return summary(
      measureGaps(keptMeshOf(object, preparation, unused), repairOptionsOf(preparation)));
}

PreparedObject prepare(const Scene& scene, const SceneObject& object,
                       const ObjectPreparation& preparation, const MemoryBudget& budget,
                       Progress& progress, PolygonMesh* usedUp) {
  constexpr std::uint64_t kPerCorner = 4 * sizeof(EdgeCorner) + 12 * sizeof(Index);
  budget.require(bytesOf(object.mesh) + object.mesh.cornerCount() * kPerCorner,
                 "finding neighbours", "raise --max-memory");
  PreparedObject prepared;
  noteReading(object, preparation.strict, prepared.warnings);
  SubdivisionLevel& base = prepared.base;
  namingObject(scene, object, [&] {
    ElementOrigin origin;
    Adjacency adjacency;
    PolygonMesh mesh =
        soundMeshOf(object, preparation, usedUp, origin, adjacency, prepared.warnings);
    progress.check();
    std::vector<Index> pointBeforeCut;
    std::vector<Index> seam;
    if (preparation.mayCrease()) {
      const SharpFeatures sharp =
          sharpFeaturesOf(object, preparation, mesh, adjacency, origin, prepared.warnings);
      CutMesh cut = cutCreases(std::move(mesh), adjacency, sharp);
      mesh = std::move(cut.mesh);
      adjacency = buildAdjacency(mesh);
      seam = std::move(cut.seam);
      pointBeforeCut = std::move(cut.pointOrigin);
      prepared.creases = cut.counts;
      origin.points = composed(origin.points, pointBeforeCut);
    }
    if (preparation.followsTexcoords)
      prepared.texcoords =
          followedTexcoords(object.mesh, mesh, {origin.weldedTo, origin.points, origin.faces});
    base = baseLevel(std::move(mesh), std::move(adjacency), preparation.boundary);
    base.seam = std::move(seam);
    prepared.faceOrigin = std::move(origin.faces);
    progress.check();
    if (!preparation.interpolates()) return;
    progress.done(kPartBeforeInterpolation);
    budget.require(bytesOf(base) + bytesOfInterpolation(base.mesh), "interpolation",
                   "raise --max-memory");
    base.mesh = interpolate(std::move(base.mesh), base.adjacency, preparation.interpolate,
                            verticesFrom(preparation.interpolatedVertices, origin),
                            prepared.interpolation, {base.seam, pointBeforeCut});
  });
  return prepared;
}

void prepareEach(const Scene& scene, int levels, const PreparationOptions& preparation,
                 const RunOptions& run, bool keepsTexcoords, const VisitPrepared& visit) {
  if (levels < 0) throw UsageError("--levels must be 0 or more, not " + std::to_string(levels));
  requirePreparable(scene, preparation);
  requireValidScene(scene);
  std::vector<ObjectPreparation> preparations = preparationsOf(scene, preparation);
  for (ObjectPreparation& one : preparations) one.followsTexcoords = keepsTexcoords;
  Progress unwatched;
  Progress& progress = run.progress != nullptr ? *run.progress : unwatched;
  onThreads(run.threads, [&] {
    prepareAll(scene, levels, preparations, MemoryBudget(run.maxMemory), progress, visit);
  });
}

Refinement refine(const Scene& scene, int levels, const PreparationOptions& preparation,
                  const RunOptions& run) {
  Refinement all;
  const auto add = [&](std::size_t, PreparedObject prepared, MemoryBudget& budget,
                       Progress& progress) {
    const bool cut = !prepared.base.seam.empty();
    const SubdivisionLevel level =
        subdividedWithin(budget, std::move(prepared.base), levels, progress, Colors::kKept);
    PolygonMesh part = cut ? joinedAlongCreases(level.mesh, level.adjacency) : level.mesh;
    all.warnings.insert(all.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
    // A vector that grows holds up to twice what it needs while it moves.
    budget.take(2 * bytesOf(part), "the refined mesh", kRefineAdvice);
    appendWithin(all.mesh, std::move(part));
  };
  prepareEach(scene, levels, preparation, run, false, add);
  return all;
}

}  // namespace vox
