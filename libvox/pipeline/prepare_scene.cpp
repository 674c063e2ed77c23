// From a scene to surfaces in index space, with what will become of them.

#include "libvox/pipeline/prepare_scene.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/asked.h"
#include "libvox/pipeline/colors.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/plan.h"
#include "libvox/pipeline/refine.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace vox {
namespace {

GridTransform chooseTransform(const Box& box, const Scene& scene, const ConvertOptions& options) {
  const bool fromOptions = options.dim || options.voxelSize;
  const auto voxelSize = fromOptions ? options.voxelSize : scene.voxelSize;
  const int dim = (fromOptions ? options.dim : scene.dim).value_or(kDefaultDim);
  GridTransform transform =
      voxelSize ? transformForVoxelSize(*voxelSize) : transformForDim(box, dim);
  const VolumeOptions volume = overriding(options.volume, scene.volume);
  transform.turn = turnFor(volume.up, volume.target.value_or(Target::kBlender));
  requireInRange(box, transform);
  return transform;
}

void moveToIndexSpace(PolygonMesh& mesh, const GridTransform& transform) {
  for (Vec3d& point : mesh.points) point = transform.toIndex(point);
}

/// What a user may not expect of an open mesh.
void warnOfBoundary(const std::string& name, const SubdivisionLevel& level, ConvertReport& report) {
  const std::size_t loops = boundaryLoops(level.mesh, level.adjacency).size();
  if (loops == 0) return;
  constexpr const char* kWhy =
      ": faces are neighbours only where their vertices coincide exactly; --weld joins near ones";
  const bool separate = loops >= level.mesh.faceCount();
  if (level.boundary == BoundaryStage::kPlain)
    report.warnings.push_back(name + " is open: it has " + std::to_string(loops) + " boundary " +
                              (loops == 1 ? "loop" : "loops") + ", from which it shrinks" +
                              (separate ? std::string(" to dots") + kWhy : ""));
  else if (separate && loops > 1)
    report.warnings.push_back(name + " falls apart into " + std::to_string(loops) +
                              " separate faces, each smoothed by itself" + kWhy);
}

/// Whether a grid tells inside from outside.
bool needsInside(std::span<const GridKind> kinds, const VolumeOptions& volume) {
  return std::any_of(kinds.begin(), kinds.end(), [&](GridKind kind) {
    return kind == GridKind::kSurface ||
           (kind == GridKind::kDensity && volume.fill == Fill::kSolid);
  });
}

/// Notes what preparation did, and refuses vertices that it moved out of the range of the grid.
void notePreparation(const PreparedObject& prepared, const GridTransform& transform,
                     ObjectReport& part, ConvertReport& report) {
  part.interpolation = prepared.interpolation;
  report.warnings.insert(report.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
  requireInRange(usedBox(prepared.base.mesh), transform, part.name + ", once interpolated,");
}

/// How an object becomes voxels as far as somebody said: near enough to tell how many.
ConversionWay wayAsked(const StopRule& until, Separation separation) {
  return {!until.untilVoxel() || separation == Separation::k26, until, separation};
}

/// Every object, ready to subdivide in index space.
std::vector<PreparedSurface> prepareObjects(const Scene& scene, const ConvertOptions& options,
                                            const GridTransform& transform, MemoryBudget& budget,
                                            Progress& progress, ConvertReport& report) {
  const StageTimer timer(report.prepareSeconds);
  std::vector<PreparedSurface> surfaces;
  for (const SceneObject& object : scene.objects) {
    ObjectReport& part = report.objects.emplace_back();
    part.name = object.name;
    part.inputFaces = object.mesh.faceCount();
    const StopRule until = stopRuleOf(object, scene, options);
    progress.begin("prepare", workOfPreparing(object, options.smoothing));
    PreparedObject prepared = prepare(scene, object, options, budget, progress);
    if (until.levels != 0) warnOfBoundary(part.name, prepared.base, report);
    notePreparation(prepared, transform, part, report);
    moveToIndexSpace(prepared.base.mesh, transform);
    budget.take(bytesOf(prepared.base), "the prepared meshes", "raise --max-memory");
    surfaces.push_back({object.name, std::move(prepared.base), wayAsked(until, options.separation),
                        textureOf(object, options.texture, transform.turn)});
  }
  return surfaces;
}

}  // namespace

Preparation prepareScene(const Scene& scene, const ConvertOptions& options, Progress& progress,
                         ConvertReport& report) {
  report.threads = tbb::this_task_arena::max_concurrency();
  Preparation prepared{MemoryBudget(options.run.maxMemory), gridsOf(scene, options),
                       overriding(options.volume, scene.volume)};
  MemoryBudget& budget = prepared.budget;
  for (const SceneObject& object : scene.objects)
    budget.take(bytesOf(object.mesh), "the input", "raise --max-memory");

  const Box box = boxOf(scene);
  prepared.transform = chooseTransform(box, scene, options);
  report.voxelSize = prepared.transform.voxelSize;
  prepared.areas = areasOf(scene, prepared.transform, progress);
  plan(scene, options, prepared.areas, prepared.kinds, progress);
  prepared.surfaces = prepareObjects(scene, options, prepared.transform, budget, progress, report);
  if (needsInside(prepared.kinds, prepared.volume))
    for (const PreparedSurface& surface : prepared.surfaces)
      requireInside(surface, prepared.volume.openMesh.value_or(OpenMesh::kSurface),
                    prepared.transform, report.warnings);
  prepared.estimate = estimateGrids(prepared.surfaces, prepared.kinds, prepared.volume);
  prepared.estimate.voxelSize = report.voxelSize;
  prepared.estimate.refusal = refusalOf(prepared.estimate, box.longestSide(), budget);
  return prepared;
}

}  // namespace vox
