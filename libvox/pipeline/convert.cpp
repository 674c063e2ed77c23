// The whole conversion, stage by stage.

#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/core/version.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/io/write_vdb.h"
#include "libvox/pipeline/asked.h"
#include "libvox/pipeline/choose.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/metadata.h"
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/prepare_scene.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"

#include <algorithm>
#include <span>

namespace vox {
namespace {

/// What became of a surface, for the report.
void noteSurface(const SurfaceReport& surface, ObjectReport& part) {
  part.submeshes = surface.submeshes;
  part.verticesOfLevel = surface.vertices;
  for (std::size_t level = 0; level < surface.vertices.size(); ++level) {
    if (surface.vertices[level] == 0) continue;
    part.levels = static_cast<int>(level);
    part.vertices += surface.vertices[level];
  }
}

/// Polygon conversion of an object, with a warning if its polygons are not what they should be.
void convertPolygons(const PreparedSurface& surface, const SurfaceOptions& options,
                     const MemoryBudget& budget, Progress& progress, ActiveVoxels& grid,
                     ObjectReport& part, std::vector<std::string>& warnings) {
  markPolygons(surface.base, surface.way.until, options, surface.way.separation, budget, progress,
               grid, part.polygons);
  part.byPolygons = true;
  part.until = surface.way.until;
  part.levels = part.polygons.levels;
  part.submeshes = part.polygons.submeshes;
  const std::uint64_t fanned = part.polygons.fanned;
  if (fanned > 0)
    warnings.push_back(part.name + ": " + std::to_string(fanned) +
                       (fanned == 1 ? " polygon is" : " polygons are") +
                       " folded or without area and became " + (fanned == 1 ? "a fan" : "fans") +
                       " of triangles");
}

/// How each object becomes voxels.
void chooseWays(const Scene& scene, const ConvertOptions& options,
                std::span<PreparedSurface> surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    surfaces[i].way = chooseWay(stopRuleOf(object, scene, options),
                                voxelizeOf(object, scene, options), options.separation);
  }
}

/// The voxels of all objects.
/// @param apart  whether each surface is to have its own besides
openvdb::MaskGrid::Ptr markObjects(const Scene& scene, std::span<PreparedSurface> surfaces,
                                   const ConvertOptions& options, const GridTransform& transform,
                                   bool apart, std::span<const double> areas, MemoryBudget& budget,
                                   Progress& progress, ConvertReport& report) {
  const StageTimer timer(report.surfaceSeconds);
  ActiveVoxels grid(budget.left());
  auto all = std::make_shared<openvdb::MaskTree>();
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    PreparedSurface& surface = surfaces[i];
    ObjectReport& part = report.objects[i];
    progress.begin("surface", workOfSurface(areas[i], scene.objects[i].mesh.cornerCount()));
    if (surface.way.polygons) {
      convertPolygons(surface, options.surface, budget, progress, grid, part, report.warnings);
    } else {
      SurfaceReport marked;
      markSurface(surface.base, options.surface, budget, progress, grid, marked);
      noteSurface(marked, part);
    }
    if (apart) {
      budget.take(2 * grid.memoryBytes(), "the grid", kScatteredAdvice);
      surface.voxels = grid.takeTree();
      all->topologyUnion(*surface.voxels);
      grid.setMemoryLimit(budget.left());
    }
    part.activeVoxels =
        (apart ? all->activeVoxelCount() : grid.countVoxels()) - report.activeVoxels;
    report.activeVoxels += part.activeVoxels;
  }
  budget.take(grid.memoryBytes(), "the grid", kScatteredAdvice);
  auto mask = openvdb::MaskGrid::create(apart ? all : grid.takeTree());
  mask->setTransform(openvdb::math::Transform::createLinearTransform(transform.voxelSize));
  return mask;
}

/// Whether it matters which voxels belong to which object.
bool needsVoxelsApart(std::span<const PreparedSurface> surfaces, std::span<const GridKind> kinds) {
  return surfaces.size() > 1 &&
         std::find(kinds.begin(), kinds.end(), GridKind::kColor) != kinds.end();
}

/// A grid with its name and metadata.
openvdb::GridBase::Ptr finished(openvdb::GridBase::Ptr grid, GridKind kind,
                                const VolumeOptions& volume, const openvdb::MetaMap& metadata) {
  grid->setName(gridNameFor(kind, volume));
  grid->setSaveFloatAsHalf(volume.half.value_or(false));
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
    grid->insertMeta(entry->first, *entry->second);
  return grid;
}

Conversion convertScene(const Scene& scene, const ConvertOptions& options, Progress& progress) {
  openvdb::initialize();
  Conversion result;
  ConvertReport& report = result.report;
  auto [budget, kinds, volume, transform, areas, surfaces, estimate] =
      prepareScene(scene, options, progress, report);
  if (!estimate.refusal.empty()) throw LimitError(estimate.refusal);
  chooseWays(scene, options, surfaces);
  const auto toMark = needsVoxels(kinds) ? std::span(surfaces) : std::span<PreparedSurface>();
  const openvdb::MaskGrid::Ptr mask =
      markObjects(scene, toMark, options, transform, needsVoxelsApart(surfaces, kinds), areas,
                  budget, progress, report);

  result.compression = volume.compression;
  if (volume.target == Target::kBlender34)
    mask->transform().postTranslate(openvdb::Vec3d(-transform.voxelSize / 2));
  progress.begin("grids", workOfGrids(areas, kinds));
  const StageTimer timer(report.gridsSeconds);
  const openvdb::MetaMap metadata = describe(scene, options, transform, report);
  for (const GridKind kind : kinds)
    result.grids.push_back(
        finished(makeGrid(kind, mask, surfaces, volume, budget, progress), kind, volume, metadata));
  if (!needsVoxels(kinds)) report.activeVoxels = result.grids[0]->activeVoxelCount();
  return result;
}

Estimate estimateScene(const Scene& scene, const ConvertOptions& options, Progress& progress,
                       std::vector<std::string>& warnings) {
  ConvertReport report;
  Preparation prepared = prepareScene(scene, options, progress, report);
  warnings = report.warnings;
  Estimate& estimate = prepared.estimate;
  if (!estimate.refusal.empty()) return estimate;
  chooseWays(scene, options, prepared.surfaces);
  estimate = estimateGrids(prepared.surfaces, prepared.kinds, prepared.volume);
  estimate.voxelSize = report.voxelSize;
  for (const PreparedSurface& surface : prepared.surfaces)
    estimate.levels = std::max(estimate.levels, levelsOf(surface, options.surface, progress));
  return estimate;
}

/// Checks what is asked for, and runs work(progress) on the threads asked for.
template <class Work>
auto onOptions(const Scene& scene, const ConvertOptions& options, Work&& work) {
  requireStopRules(scene, options);
  const VolumeOptions volume = overriding(options.volume, scene.volume);
  requireValid(volume);
  if (volume.compression) requireCompression(*volume.compression);
  requireValidScene(scene);
  Progress unwatched;
  Progress& progress = options.run.progress != nullptr ? *options.run.progress : unwatched;
  return onThreads(options.run.threads, [&] { return work(progress); });
}

}  // namespace

Box boxOf(const Scene& scene) {
  Box box;
  for (const SceneObject& object : scene.objects) box.add(usedBox(object.mesh));
  return box;
}

Conversion convert(const Scene& scene, const ConvertOptions& options) {
  return onOptions(scene, options,
                   [&](Progress& progress) { return convertScene(scene, options, progress); });
}

Estimate estimate(const Scene& scene, const ConvertOptions& options,
                  std::vector<std::string>& warnings) {
  return onOptions(scene, options, [&](Progress& progress) {
    return estimateScene(scene, options, progress, warnings);
  });
}

void writeGrids(std::iostream& stream, const Conversion& conversion, Progress* progress) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  for (const auto& grid : conversion.grids)
    if (const auto gain = (*grid)[kGainMetadata]) metadata.insertMeta(kGainMetadata, *gain);
  if (progress == nullptr)
    return writeVdb(stream, conversion.grids, metadata, conversion.compression);
  progress->beginLast("write");
  WatchedStream watched(*stream.rdbuf(), *progress, expectedBytes(conversion.grids));
  writeVdb(watched, conversion.grids, metadata, conversion.compression);
}

void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite,
                Progress* progress) {
  AtomicFile output(file, overwrite);
  writeGrids(output.stream(), conversion, progress);
  if (progress != nullptr) progress->check();
  output.commit();
}

}  // namespace vox
