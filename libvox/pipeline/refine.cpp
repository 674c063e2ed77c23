// Subdivision of the objects of a scene within a memory budget.

#include "libvox/pipeline/refine.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/validate.h"

#include <string>
#include <utility>

namespace vox {
namespace {

constexpr const char* kAdvice = "use fewer levels, or raise --max-memory";

/// Repeats a mesh error with the file and object it is about.
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

SubdivisionLevel subdivided(SubdivisionLevel level, int levels, const MemoryBudget& budget) {
  for (int k = 1; k <= levels; ++k) {
    budget.require(bytesOf(level) + bytesOfImage(level) + bytesOfNextTopology(level),
                   "level " + std::to_string(k), kAdvice);
    level = nextLevel(level, imageVertices(level.mesh));
  }
  return level;
}

void append(PolygonMesh& all, PolygonMesh part) {
  if (std::uint64_t{all.cornerCount()} + part.cornerCount() >= kNone ||
      std::uint64_t{all.pointCount()} + part.pointCount() >= kNone)
    throw LimitError("the objects together have more elements than fit in 32 bits");
  if (all.faceCount() == 0) {
    all = std::move(part);
    return;
  }
  const Index firstPoint = all.pointCount();
  const Index firstCorner = all.cornerCount();
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (const Index v : part.faceVertices) all.faceVertices.push_back(firstPoint + v);
  for (Index f = 0; f < part.faceCount(); ++f)
    all.faceOffsets.push_back(firstCorner + part.faceOffsets[f + 1]);
}

PolygonMesh refineAll(const Scene& scene, int levels, const RunOptions& options) {
  MemoryBudget budget(options.maxMemory);
  PolygonMesh all;
  for (const SceneObject& object : scene.objects) {
    budget.take(bytesOf(object.mesh), "the input", kAdvice);
    PolygonMesh part = object.mesh;
    if (levels > 0)
      part = subdivided(baseLevelOf(scene, object, std::move(part), budget), levels, budget).mesh;
    // A vector that grows holds up to twice what it needs while it moves.
    budget.take(2 * bytesOf(part), "the refined mesh", kAdvice);
    append(all, std::move(part));
  }
  return all;
}

}  // namespace

std::uint64_t bytesOf(const PolygonMesh& mesh) {
  return mesh.points.size() * sizeof(Vec3d) +
         (mesh.faceOffsets.size() + mesh.faceVertices.size()) * sizeof(Index);
}

std::uint64_t bytesOf(const SubdivisionLevel& level) {
  return bytesOf(level.mesh) + std::uint64_t{level.mesh.cornerCount()} * 2 * sizeof(Index);
}

std::uint64_t bytesOfImage(const SubdivisionLevel& level) {
  return std::uint64_t{level.mesh.cornerCount()} * sizeof(Vec3d);
}

std::uint64_t bytesOfNextTopology(const SubdivisionLevel& level) {
  constexpr std::uint64_t kTables = 4 * sizeof(Index);  // edge, ring, offset, slot per corner
  constexpr std::uint64_t kCorner = 4 * sizeof(Index);  // vertex, twin, face; offsets, rounded up
  return level.mesh.cornerCount() * kTables + nextCornerCount(level) * kCorner;
}

void requireValidScene(const Scene& scene) {
  for (const SceneObject& object : scene.objects)
    namingObject(scene, object, [&] { requireValidArrays(object.mesh); });
}

SubdivisionLevel baseLevelOf(const Scene& scene, const SceneObject& object, PolygonMesh mesh,
                             const MemoryBudget& budget) {
  constexpr std::uint64_t kPerCorner = 2 * sizeof(EdgeCorner) + 4 * sizeof(Index);
  budget.require(bytesOf(mesh) + mesh.cornerCount() * kPerCorner, "finding neighbours",
                 "raise --max-memory");
  return namingObject(scene, object, [&] { return baseLevel(std::move(mesh)); });
}

PolygonMesh refine(const Scene& scene, int levels, const RunOptions& options) {
  if (levels < 0) throw UsageError("--levels must be 0 or more, not " + std::to_string(levels));
  requireValidScene(scene);
  return onThreads(options.threads, [&] { return refineAll(scene, levels, options); });
}

}  // namespace vox
