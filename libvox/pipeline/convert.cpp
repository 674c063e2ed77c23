// The whole conversion: the only place that knows every stage.

#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/core/version.h"
#include "libvox/grid/transform.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/io/write_vdb.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/pipeline/choose.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/metadata.h"
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <span>
#include <utility>

namespace vox {
namespace {

/// Adds the time of a scope to a total.
class StageTimer {
 public:
  explicit StageTimer(double& total) : total_(total) {}
  ~StageTimer() { total_ += watch_.seconds(); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& total_;
  Stopwatch watch_;
};

// Resolution

GridTransform chooseTransform(const Box& box, const Scene& scene, const ConvertOptions& options) {
  const bool fromOptions = options.dim || options.voxelSize;
  const auto voxelSize = fromOptions ? options.voxelSize : scene.voxelSize;
  const int dim = (fromOptions ? options.dim : scene.dim).value_or(kDefaultDim);
  GridTransform transform =
      voxelSize ? transformForVoxelSize(*voxelSize) : transformForDim(box, dim);
  transform.turn = turnOf(overriding(options.volume, scene.volume));
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

// Where to stop

StopRule stopRuleOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options) {
  for (const auto& said : {options.until, object.until, scene.until})
    if (said) return *said;
  return {};
}

Voxelize voxelizeOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options) {
  for (const auto& said : {options.voxelize, object.voxelize, scene.voxelize})
    if (said) return *said;
  return Voxelize::kAuto;
}

void requireStopRules(const Scene& scene, const ConvertOptions& options) {
  for (const SceneObject& object : scene.objects) {
    const std::string fault = faultOf(stopRuleOf(object, scene, options),
                                      voxelizeOf(object, scene, options), options.separation);
    if (!fault.empty()) throw UsageError(object.name + ": " + fault);
  }
}

// Progress

/// Area of each object's control mesh, in square voxels: what the work of the later stages follows.
/// Zeros when nobody watches.
std::vector<double> areasOf(const Scene& scene, const GridTransform& transform,
                            const Progress& progress) {
  std::vector<double> areas(scene.objects.size(), 0.0);
  for (std::size_t i = 0; progress.watched() && i < areas.size(); ++i)
    areas[i] = areaOf(scene.objects[i].mesh) / transform.voxelSize / transform.voxelSize;
  return areas;
}

double workOfPreparing(const SceneObject& object, const ConvertOptions& options) {
  return workOfPreparing(object.mesh,
                         interpolates(overriding(options.smoothing, object.smoothing)));
}

/// Voxels of a level set beside those of a surface, about.
constexpr double kVoxelsOfBand = 4;

double workOfWriting(GridKind kind, double area) {
  switch (kind) {
    case GridKind::kDensity:
      return workOfWritingDensity(area);
    case GridKind::kMask:
      return workOfWritingMask(area);
    case GridKind::kSurface:
      return kVoxelsOfBand * workOfWritingDensity(area);
    case GridKind::kNormal:
      return workOfWritingNormals(area);
    case GridKind::kColor:
      return workOfWritingColor(area);
  }
  return 0;
}

/// Announces all stages, writing included.
void plan(const Scene& scene, const ConvertOptions& options, std::span<const double> areas,
          std::span<const GridKind> kinds, Progress& progress) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    progress.plan(workOfPreparing(object, options) +
                  workOfSurface(areas[i], object.mesh.cornerCount()));
    for (const GridKind kind : kinds) progress.plan(workOfWriting(kind, areas[i]));
  }
  progress.plan(workOfGrids(areas, kinds));
}

// Conversion

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
                     const MemoryBudget& budget, Progress& progress, SurfaceGrid& grid,
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
    progress.begin("prepare", workOfPreparing(object, options));
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

/// How each object becomes voxels.
void chooseWays(const Scene& scene, const ConvertOptions& options, const Progress& progress,
                std::span<PreparedSurface> surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    surfaces[i].way = chooseWay(surfaces[i].base, stopRuleOf(object, scene, options),
                                voxelizeOf(object, scene, options), options.separation,
                                options.surface, progress);
  }
}

/// The voxels of all objects.
/// @param apart  whether each surface is to have its own besides
openvdb::MaskGrid::Ptr markObjects(const Scene& scene, std::span<PreparedSurface> surfaces,
                                   const ConvertOptions& options, const GridTransform& transform,
                                   bool apart, std::span<const double> areas, MemoryBudget& budget,
                                   Progress& progress, ConvertReport& report) {
  const StageTimer timer(report.surfaceSeconds);
  SurfaceGrid grid(budget.left());
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

/// The grids asked for.
std::vector<GridKind> gridsOf(const Scene& scene, const ConvertOptions& options) {
  std::vector<GridKind> kinds =
      options.grids.value_or(scene.grids.value_or(std::vector{GridKind::kDensity}));
  const bool colored = std::find(kinds.begin(), kinds.end(), GridKind::kColor) != kinds.end();
  if (!options.texture || colored) return kinds;
  if (options.grids) throw UsageError("--texture needs color among --grids");
  kinds.push_back(GridKind::kColor);
  return kinds;
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

/// Everything that a conversion begins with.
struct Preparation {
  MemoryBudget budget;
  std::vector<GridKind> kinds;
  VolumeOptions volume;
  GridTransform transform = {};
  std::vector<double> areas = {};
  std::vector<PreparedSurface> surfaces = {};
  Estimate estimate = {};
};

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

Conversion convertScene(const Scene& scene, const ConvertOptions& options, Progress& progress) {
  openvdb::initialize();
  Conversion result;
  ConvertReport& report = result.report;
  auto [budget, kinds, volume, transform, areas, surfaces, estimate] =
      prepareScene(scene, options, progress, report);
  if (!estimate.refusal.empty()) throw LimitError(estimate.refusal);
  chooseWays(scene, options, progress, surfaces);
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
  chooseWays(scene, options, progress, prepared.surfaces);
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
