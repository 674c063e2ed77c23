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
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <sstream>
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

Box boxOf(const Scene& scene) {
  Box box;
  for (const SceneObject& object : scene.objects) {
    const Box part = usedBox(object.mesh);
    if (part.empty()) continue;
    box.add(part.low);
    box.add(part.high);
  }
  return box;
}

GridTransform chooseTransform(const Box& box, const Scene& scene, const ConvertOptions& options) {
  const bool fromOptions = options.dim || options.voxelSize;
  const auto voxelSize = fromOptions ? options.voxelSize : scene.voxelSize;
  const int dim = (fromOptions ? options.dim : scene.dim).value_or(kDefaultDim);
  const GridTransform transform =
      voxelSize ? transformForVoxelSize(*voxelSize) : transformForDim(box, dim);
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

// Memory of grids

/// Bytes of a tree of floats with the nodes of a mask.
std::uint64_t bytesOfDensity(const openvdb::MaskTree& mask) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  using Upper = openvdb::FloatTree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  const auto nodes = mask.nodeCount();  // leaves first, root last
  return nodes[0] * (sizeof(Leaf) + Leaf::SIZE * sizeof(float)) + nodes[1] * sizeof(Lower) +
         nodes[2] * sizeof(Upper);
}

constexpr const char* kScattered =
    "the model is scattered over much space: use larger voxels, or raise --max-memory";

/// Bytes of nodes per square voxel of a surface: 1.5 leaves per 64 and 1.5 inner nodes per 16384,
/// averaged over directions.
template <class TreeT>
double bytesPerArea(double valueBytes) {
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  return 1.5 * ((sizeof(Leaf) + Leaf::SIZE * valueBytes) / 64 + sizeof(Lower) / 16384.0);
}

double bytesOfGrids(double area, std::span<const GridKind> kinds) {
  double perArea = bytesPerArea<openvdb::MaskTree>(0);
  for (const GridKind kind : kinds)
    if (kind == GridKind::kDensity) perArea += bytesPerArea<openvdb::FloatTree>(sizeof(float));
  return area * perArea;
}

/// Refuses a surface that cannot fit, before the work starts, and says which resolution would. The
/// surface has about the area of the control mesh; far less where it shrinks from a free boundary,
/// so nothing is refused there.
void requireGridsFit(const SubdivisionLevel& base, std::span<const GridKind> kinds,
                     const GridTransform& transform, double longestSide,
                     const MemoryBudget& budget) {
  const auto& twin = base.adjacency.twin;
  const bool open = std::find(twin.begin(), twin.end(), kNone) != twin.end();
  if (open && base.boundary == BoundaryStage::kPlain) return;
  const double bytes = bytesOfGrids(areaOf(base.mesh), kinds);
  constexpr double kCertain = 4;
  const double left = static_cast<double>(budget.left());
  if (bytes <= kCertain * left) return;
  const double larger = std::sqrt(kCertain * bytes / left) * transform.voxelSize;
  std::ostringstream advice;
  advice.precision(3);
  advice << "use --dim " << static_cast<std::int64_t>(std::max(1.0, longestSide / larger))
         << " or --voxel-size " << larger << ", or raise --max-memory";
  constexpr double kMostBytes = 1e18;
  budget.require(static_cast<std::uint64_t>(std::min(bytes, kMostBytes)), "the grid", advice.str());
}

// Metadata

std::string optionText(const GridTransform& transform, const Scene& scene,
                       const ConvertOptions& options) {
  std::ostringstream text;
  text.precision(17);
  if (options.voxelSize || (!options.dim && scene.voxelSize))
    text << "voxel-size=" << transform.voxelSize;
  else
    text << "dim=" << options.dim.value_or(scene.dim.value_or(kDefaultDim));
  const SmoothingOptions& smoothing = options.smoothing;
  if (smoothing.boundary) text << " boundary=" << boundaryRuleName(*smoothing.boundary);
  if (smoothing.interpolate) text << " interpolate=" << interpolateName(*smoothing.interpolate);
  if (smoothing.interpolatedVertices)
    text << " interpolated-vertices=" << smoothing.interpolatedVertices->size();
  if (options.weldTolerance) text << " weld=" << *options.weldTolerance;
  if (options.until) text << " until=" << stopRuleName(*options.until);
  if (options.voxelize) text << " voxelize=" << voxelizeName(*options.voxelize);
  return text.str();
}

openvdb::MetaMap describe(const Scene& scene, const ConvertOptions& options,
                          const GridTransform& transform, const ConvertReport& report) {
  int levels = 0;
  for (const ObjectReport& object : report.objects) levels = std::max(levels, object.levels);
  const auto voxels = static_cast<openvdb::Int64>(report.activeVoxels);
  const char* guarantee = options.separation == Separation::k26 ? "26-separating" : "6-separating";
  openvdb::MetaMap metadata;
  metadata.insertMeta("vox_version", openvdb::StringMetadata(version()));
  if (!scene.files.empty()) {
    metadata.insertMeta("vox_input", openvdb::StringMetadata(scene.files[0].filename().string()));
    metadata.insertMeta("vox_input_hash", openvdb::StringMetadata(scene.inputHash));
  }
  metadata.insertMeta("vox_options",
                      openvdb::StringMetadata(optionText(transform, scene, options)));
  metadata.insertMeta("vox_levels", openvdb::Int32Metadata(levels));
  metadata.insertMeta("vox_guarantee", openvdb::StringMetadata(guarantee));
  metadata.insertMeta("vox_active_voxels", openvdb::Int64Metadata(voxels));
  return metadata;
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

double workOfGrids(std::span<const double> areas, std::span<const GridKind> kinds) {
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  double work = 0;
  for (const GridKind kind : kinds)
    if (kind == GridKind::kDensity) work += workOfDensity(area);
  return work;
}

/// Announces all stages, writing included.
void plan(const Scene& scene, const ConvertOptions& options, std::span<const double> areas,
          std::span<const GridKind> kinds, Progress& progress) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    progress.plan(workOfPreparing(object, options) +
                  workOfSurface(areas[i], object.mesh.cornerCount()));
    for (const GridKind kind : kinds)
      progress.plan(kind == GridKind::kDensity ? workOfWritingDensity(areas[i])
                                               : workOfWritingMask(areas[i]));
  }
  progress.plan(workOfGrids(areas, kinds));
}

/// Bytes of a file of these grids, as once measured.
std::uint64_t expectedBytes(const Conversion& conversion) {
  constexpr std::uint64_t kPerLeaf = 145;
  constexpr std::uint64_t kPerLeafOfValues = 195;
  std::uint64_t bytes = 0;
  for (const auto& grid : conversion.grids)
    bytes += grid->constBaseTree().leafCount() *
             (grid->isType<openvdb::MaskGrid>() ? kPerLeaf : kPerLeafOfValues);
  return bytes;
}

// Conversion

openvdb::GridBase::Ptr makeGrid(GridKind kind, const openvdb::MaskGrid::Ptr& mask,
                                MemoryBudget& budget) {
  if (kind == GridKind::kMask) return mask;
  budget.take(bytesOfDensity(mask->tree()), "the density grid", kScattered);
  return densityGrid(*mask);
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
void convertPolygons(PreparedObject prepared, const ConversionWay& way,
                     const SurfaceOptions& options, const MemoryBudget& budget, Progress& progress,
                     SurfaceGrid& grid, ObjectReport& part, std::vector<std::string>& warnings) {
  markPolygons(std::move(prepared.base), way.until, options, way.separation, budget, progress, grid,
               part.polygons);
  part.byPolygons = true;
  part.until = way.until;
  part.levels = part.polygons.levels;
  part.submeshes = part.polygons.submeshes;
  const std::uint64_t fanned = part.polygons.fanned;
  if (fanned > 0)
    warnings.push_back(part.name + ": " + std::to_string(fanned) +
                       (fanned == 1 ? " polygon is" : " polygons are") +
                       " folded or without area and became " + (fanned == 1 ? "a fan" : "fans") +
                       " of triangles");
}

openvdb::MaskGrid::Ptr convertObjects(const Scene& scene, const ConvertOptions& options,
                                      const GridTransform& transform, double longestSide,
                                      std::span<const double> areas,
                                      std::span<const GridKind> kinds, MemoryBudget& budget,
                                      Progress& progress, ConvertReport& report) {
  SurfaceGrid grid(budget.left());
  for (const SceneObject& object : scene.objects) {
    const double area = areas[report.objects.size()];
    ObjectReport& part = report.objects.emplace_back();
    part.name = object.name;
    part.inputFaces = object.mesh.faceCount();
    const StopRule until = stopRuleOf(object, scene, options);
    PreparedObject prepared;
    {
      progress.begin("prepare", workOfPreparing(object, options));
      const StageTimer timer(report.prepareSeconds);
      prepared = prepare(scene, object, options, budget, progress);
      if (until.levels != 0) warnOfBoundary(part.name, prepared.base, report);
      notePreparation(prepared, transform, part, report);
      moveToIndexSpace(prepared.base.mesh, transform);
      requireGridsFit(prepared.base, kinds, transform, longestSide, budget);
    }
    progress.begin("surface", workOfSurface(area, object.mesh.cornerCount()));
    const StageTimer timer(report.surfaceSeconds);
    const ConversionWay way = chooseWay(prepared.base, until, voxelizeOf(object, scene, options),
                                        options.separation, options.surface, progress);
    if (way.polygons) {
      convertPolygons(std::move(prepared), way, options.surface, budget, progress, grid, part,
                      report.warnings);
    } else {
      SurfaceReport surface;
      markSurface(prepared.base, options.surface, budget, progress, grid, surface);
      noteSurface(surface, part);
    }
    part.activeVoxels = grid.countVoxels() - report.activeVoxels;
    report.activeVoxels += part.activeVoxels;
  }
  budget.take(grid.memoryBytes(), "the grid", kScattered);
  auto mask = openvdb::MaskGrid::create(grid.takeTree());
  mask->setName(gridName(GridKind::kMask));
  mask->setTransform(openvdb::math::Transform::createLinearTransform(transform.voxelSize));
  return mask;
}

Conversion convertScene(const Scene& scene, const ConvertOptions& options, Progress& progress) {
  openvdb::initialize();
  Conversion result;
  result.report.threads = tbb::this_task_arena::max_concurrency();
  MemoryBudget budget(options.run.maxMemory);
  for (const SceneObject& object : scene.objects)
    budget.take(bytesOf(object.mesh), "the input", "raise --max-memory");

  const Box box = boxOf(scene);
  const GridTransform transform = chooseTransform(box, scene, options);
  const std::vector<GridKind> kinds =
      options.grids.value_or(scene.grids.value_or(std::vector{GridKind::kDensity}));
  const std::vector<double> areas = areasOf(scene, transform, progress);
  plan(scene, options, areas, kinds, progress);
  result.report.voxelSize = transform.voxelSize;
  const openvdb::MaskGrid::Ptr mask = convertObjects(scene, options, transform, box.longestSide(),
                                                     areas, kinds, budget, progress, result.report);

  progress.begin("grids", workOfGrids(areas, kinds));
  const StageTimer timer(result.report.gridsSeconds);
  const openvdb::MetaMap metadata = describe(scene, options, transform, result.report);
  for (const GridKind kind : kinds) {
    openvdb::GridBase::Ptr grid = makeGrid(kind, mask, budget);
    progress.check();
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
      grid->insertMeta(entry->first, *entry->second);
    result.grids.push_back(std::move(grid));
  }
  return result;
}

}  // namespace

Conversion convert(const Scene& scene, const ConvertOptions& options) {
  requireStopRules(scene, options);
  requireValidScene(scene);
  Progress unwatched;
  Progress& progress = options.run.progress != nullptr ? *options.run.progress : unwatched;
  return onThreads(options.run.threads, [&] { return convertScene(scene, options, progress); });
}

void writeGrids(std::iostream& stream, const Conversion& conversion, Progress* progress) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  if (progress == nullptr) return writeVdb(stream, conversion.grids, metadata);
  progress->beginLast("write");
  WatchedStream watched(*stream.rdbuf(), *progress, expectedBytes(conversion));
  writeVdb(watched, conversion.grids, metadata);
}

void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite,
                Progress* progress) {
  AtomicFile output(file, overwrite);
  writeGrids(output.stream(), conversion, progress);
  if (progress != nullptr) progress->check();
  output.commit();
}

}  // namespace vox
