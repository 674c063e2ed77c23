// The whole conversion, stage by stage.

#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/core/version.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/crop.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/pipeline/colors.h"
#include "libvox/pipeline/cut.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/metadata.h"
#include "libvox/pipeline/part_grid.h"
#include "libvox/pipeline/parts.h"
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/prepare_scene.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/soft_density.h"
#include "libvox/pipeline/surface.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <sstream>

namespace vox {
namespace {

/// True if each object's voxels are needed separately.
bool needsObjectsApart(const PreparedScene& prepared, const Request& request) {
  return prepared.surfaces.size() > 1 && (request.volume.alpha == Alpha::kCut ||
                                          std::find(request.grids.begin(), request.grids.end(),
                                                    GridKind::kColor) != request.grids.end());
}

/// Whether the surfaces are needed once their voxels are marked.
bool needsSurfaces(const Request& request) {
  return request.splits || request.volume.alpha == Alpha::kCut ||
         needsSurfaces(request.grids, request.volume);
}

/// The transform of the output: that of the conversion in the axes of the grid.
openvdb::math::Transform::Ptr transformOfFile(const Request& request,
                                              const GridTransform& transform) {
  using openvdb::math::Transform;
  const double size = transform.voxelSize;
  const bool isMoved = request.volume.target == Target::kBlender34;
  const Vec3d origin =
      request.resolution.origin.value_or(Vec3d::Constant(isMoved ? -size / 2 : 0.0));
  const Transform::Ptr made = Transform::createLinearTransform(size);
  if (!origin.isZero(0)) made->postTranslate(openvdb::Vec3d(origin.data()));
  return made;
}

/// Soft values and the colours around them come from voxels up to this far away.
constexpr int kMarginOfSoft = 4;  // voxels

/// The voxels whose marks the grids of a region need: all where the marks tell the inside.
Region regionOfMarks(const Request& request, const Region& region) {
  if (needsInside(request.grids, request.volume)) return {};
  return request.volume.edge == Edge::kSoft ? region.grown(kMarginOfSoft) : region;
}

/// Some voxels of a mask.
openvdb::MaskGrid::Ptr cropped(const openvdb::MaskGrid& mask, const Region& region) {
  auto voxels = std::make_shared<openvdb::MaskTree>(mask.tree());
  crop(*voxels, region);
  openvdb::tools::pruneInactive(*voxels);
  auto grid = openvdb::MaskGrid::create(voxels);
  grid->setTransform(mask.transform().copy());
  return grid;
}

/// Crops a grid. A level set keeps the inner sides of nodes without active voxels. Pages stay as
/// they are in the whole.
void cropGrid(openvdb::GridBase& grid, const Region& region) {
  if (region.isAll()) return;
  const auto cropTree = [&](auto& typed) {
    if (region.box()) {
      cropToBox(typed.tree(), *region.box());
      if (typed.getGridClass() == openvdb::GRID_LEVEL_SET)
        openvdb::tools::prune(typed.tree());
      else
        openvdb::tools::pruneInactive(typed.tree());
    }
    if (region.hasPages()) cropToPages(typed.tree(), region);
  };
  using Kinds = openvdb::TypeList<openvdb::MaskGrid, openvdb::FloatGrid, openvdb::Vec3SGrid,
                                  openvdb::Int32Grid>;
  grid.apply<Kinds>(cropTree);
}

/// Warns of a box that holds nothing, and of cuts that leave nothing.
void warnOfEmpty(const Conversion& conversion, const Request& request, ConvertReport& report) {
  if (std::all_of(conversion.grids.begin(), conversion.grids.end(),
                  [](const auto& grid) { return grid->activeVoxelCount() == 0; }))
    report.warnings.emplace_back(
        request.crops()
            ? "no active voxel lies in the box of --bounds or --clip: the grids are empty"
            : "--alpha cut left no voxel, because everything is transparent: the grids are empty");
}

/// Switches on the voxels of a prepared scene, object by object.
class SceneMarker {
 public:
  /// @param apart  each surface gets the voxels of its own, besides
  SceneMarker(const Request& request, bool apart, PreparedScene& prepared, Progress& progress,
              ConvertReport& report)
      : request_(request),
        apart_(apart),
        keepsSurfaces_(needsSurfaces(request)),
        prepared_(prepared),
        progress_(progress),
        report_(report),
        grid_(prepared.budget.left(), regionOfMarks(request, prepared.region)) {}

  void mark(std::size_t object) {
    PreparedSurface& surface = prepared_.surfaces[object];
    ObjectReport& part = report_.objects[object];
    progress_.begin("surface", workOfSurface(prepared_.areas[object], surface.inputCorners));
    if (surface.way.polygons)
      markByPolygons(surface, part);
    else
      markByVertices(surface, part);
    if (apart_) takeApart(surface);
    if (!keepsSurfaces_) surface.base = {};
    const std::uint64_t voxels = apart_ ? all_->activeVoxelCount() : grid_.countVoxels();
    part.activeVoxels = voxels - report_.activeVoxels;
    report_.activeVoxels = voxels;
  }

  /// The voxels of all objects. After the last object.
  openvdb::MaskGrid::Ptr take() {
    prepared_.budget.take(grid_.memoryBytes(), "the grid", kScatteredAdvice);
    auto mask = openvdb::MaskGrid::create(apart_ ? all_ : grid_.takeTree());
    if (!apart_ && request_.volume.alpha == Alpha::kCut) {
      cutTransparent(mask->tree(), prepared_.surfaces[0], prepared_.budget, progress_);
      report_.activeVoxels = report_.objects[0].activeVoxels = mask->activeVoxelCount();
    }
    mask->setTransform(transformOfFile(request_, prepared_.transform));
    return mask;
  }

 private:
  void markByVertices(const PreparedSurface& surface, ObjectReport& part) {
    SurfaceReport marked;
    markSurface(surface.base, surface.options, prepared_.budget, progress_, grid_, marked);
    part.submeshes = marked.submeshes;
    part.verticesOfLevel = marked.vertices;
    for (std::size_t level = 0; level < marked.vertices.size(); ++level) {
      if (marked.vertices[level] == 0) continue;
      part.levels = static_cast<int>(level);
      part.vertices += marked.vertices[level];
    }
  }

  void markByPolygons(const PreparedSurface& surface, ObjectReport& part) {
    markPolygons(surface.base, surface.way.until, surface.options, surface.way.separation,
                 prepared_.budget, progress_, grid_, part.polygons);
    part.byPolygons = true;
    part.until = surface.way.until;
    part.levels = part.polygons.levels;
    part.submeshes = part.polygons.submeshes;
    const std::uint64_t fanned = part.polygons.fanned;
    if (fanned > 0)
      report_.warnings.push_back(part.name + ": " + std::to_string(fanned) +
                                 (fanned == 1 ? " polygon is" : " polygons are") +
                                 " folded or without area and became " +
                                 (fanned == 1 ? "a fan" : "fans") + " of triangles");
  }

  void takeApart(PreparedSurface& surface) {
    prepared_.budget.take(2 * grid_.memoryBytes(), "the grid", kScatteredAdvice);
    surface.voxels = grid_.takeTree();
    if (request_.volume.alpha == Alpha::kCut)
      cutTransparent(*surface.voxels, surface, prepared_.budget, progress_);
    all_->topologyUnion(*surface.voxels);
    grid_.setMemoryLimit(prepared_.budget.left());
  }

  const Request& request_;
  bool apart_;
  bool keepsSurfaces_;
  PreparedScene& prepared_;
  Progress& progress_;
  ConvertReport& report_;
  ActiveVoxels grid_;
  openvdb::MaskTree::Ptr all_ = std::make_shared<openvdb::MaskTree>();  // if objects are apart
};

/// The voxels of all objects.
openvdb::MaskGrid::Ptr markObjects(const Request& request, PreparedScene& prepared,
                                   Progress& progress, ConvertReport& report) {
  SceneMarker marker(request, needsObjectsApart(prepared, request), prepared, progress, report);
  for (std::size_t i = 0; i < prepared.surfaces.size(); ++i) marker.mark(i);
  return marker.take();
}

/// The order in which grids are made: densities first, because others may cover their voxels.
std::vector<std::size_t> orderOf(const std::vector<GridKind>& kinds) {
  std::vector<std::size_t> order(kinds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return kinds[i] == GridKind::kDensity; });
  return order;
}

/// Largest absolute value that a grid of numbers may have, in any part of a run. Vectors and masks:
/// 1, because normals are units, and colours are at most 1.
double largestValue(const openvdb::GridBase& grid, const VolumeSettings& volume) {
  const auto* numbers = dynamic_cast<const openvdb::FloatGrid*>(&grid);
  if (numbers == nullptr) return 1;
  if (const auto gain = grid.getMetadata<openvdb::FloatMetadata>(kGainMetadata))
    return double{gain->value()};
  return std::max(volume.band.in, volume.band.out) * grid.voxelSize()[0];
}

/// Whether floats of 16 bits hold the values of a grid as well as they hold numbers near 1.
bool fitsHalf(const openvdb::GridBase& grid, const VolumeSettings& volume,
              std::vector<std::string>& warnings) {
  constexpr double kLargest = 65504, kLeastNormal = 1.0 / 16384;
  const double largest = largestValue(grid, volume);
  if (largest >= kLeastNormal && largest <= kLargest) return true;
  std::ostringstream text;
  text << "the grid " << grid.getName() << " is written with 32 bits: its values, up to " << largest
       << ", are too " << (largest > 1 ? "large" : "small")
       << " for 16; with --scale the model has other units";
  warnings.push_back(text.str());
  return false;
}

/// A grid with its name and metadata.
openvdb::GridBase::Ptr finished(openvdb::GridBase::Ptr grid, GridKind kind,
                                const VolumeSettings& volume, const openvdb::MetaMap& metadata,
                                std::vector<std::string>& warnings) {
  grid->setName(gridNameFor(kind, volume.target));
  if (kind != GridKind::kPart)
    grid->setSaveFloatAsHalf(volume.half && fitsHalf(*grid, volume, warnings));
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
    grid->insertMeta(entry->first, *entry->second);
  return grid;
}

/// The active voxels of a scene.
struct MarkedVoxels {
  openvdb::MaskGrid::Ptr all;   ///< as many as tell the inside
  openvdb::MaskGrid::Ptr near;  ///< those asked for, and a few around them
  bool hasMore = false;         ///< than asked for
};

/// @param region  of the grids; all voxels unless the request crops
MarkedVoxels markedVoxels(const Request& request, const Region& region, PreparedScene& prepared,
                          Progress& progress, ConvertReport& report) {
  const StageTimer timer(report.surfaceSeconds);
  const auto mask = markObjects(request, prepared, progress, report);
  const bool hasMore =
      needsInside(request.grids, request.volume) || request.volume.edge == Edge::kSoft;
  if (!request.crops() || !hasMore) return {mask, mask};
  const Region around = region.grown(kMarginOfSoft);
  for (PreparedSurface& surface : prepared.surfaces)
    if (surface.voxels) crop(*surface.voxels, around);
  report.activeVoxels = cropped(*mask, prepared.region)->activeVoxelCount();
  return {mask, cropped(*mask, around), true};
}

/// The grids of a request, in its order, before they are cropped and named.
struct MadeGrids {
  std::vector<openvdb::GridBase::Ptr> asked;
  openvdb::FloatGrid::Ptr density;  ///< null if nothing needs it
  openvdb::Int32Grid::Ptr parts;
};

/// Makes grids one after the other; later ones use earlier ones.
class GridMaker {
 public:
  GridMaker(const Request& request, PreparedScene& prepared, Progress& progress,
            ConvertReport& report)
      : request_(request),
        prepared_(prepared),
        progress_(progress),
        report_(report),
        marks_(needsVoxels(request.grids)),
        area_(std::accumulate(prepared.areas.begin(), prepared.areas.end(), 0.0)) {
    // Parts go from the surface to the inside, so they are cropped at last.
    sources_.region = request.spreadsParts() ? Region{} : prepared.region;
    if (cutsLevelSets(prepared.estimate.shares)) sources_.bandOfPart = prepared.region;
    sources_.surfaces = prepared.surfaces;
    sources_.markVoxels = [this]() -> const openvdb::MaskTree& { return voxelsOfAll(); };
    sources_.partCount = prepared.partNames.size();
    voxels_.all = openvdb::MaskGrid::create();
    voxels_.all->setTransform(transformOfFile(request, prepared.transform));
    voxels_.near = voxels_.all;
    if (marks_) voxels_ = markedVoxels(request, sources_.region, prepared, progress, report);
  }
  GridMaker(const GridMaker&) = delete;
  GridMaker& operator=(const GridMaker&) = delete;

  MadeGrids make() {
    made_.asked.resize(request_.grids.size());
    for (const std::size_t i : orderOf(request_.grids)) {
      const GridKind kind = request_.grids[i];
      progress_.begin("grids", partOfWork(kind));
      made_.asked[i] = kind == GridKind::kPart ? parts() : gridOf(kind, request_.volume);
      if (kind == GridKind::kDensity) noteDensity(made_.asked[i]);
      if (made_.asked[i] == voxels_.near && voxels_.hasMore)
        made_.asked[i] = voxels_.near->deepCopyGrid();  // others still need it
    }
    if (request_.splits) parts();
    return made_;
  }

 private:
  /// A level set may have to mark voxels in between, as half of its work.
  double partOfWork(GridKind kind) const {
    const double work = workOfGrid(kind, request_.volume.edge, area_);
    return kind == GridKind::kSurface && !marks_ ? work / 2 : work;
  }

  const openvdb::MaskTree& voxelsOfAll() {
    if (marks_) return voxels_.all->tree();
    ConvertReport unused = report_;
    later_ = markObjects(request_, prepared_, progress_, unused);
    progress_.begin("grids", partOfWork(GridKind::kSurface));  // go on where makeGrid was
    return later_->tree();
  }

  openvdb::GridBase::Ptr gridOf(GridKind kind, const VolumeSettings& settings) {
    sources_.mask = kind == GridKind::kDensity ? voxels_.all : voxels_.near;
    return makeGrid(kind, sources_, settings, prepared_.budget, progress_, report_.warnings);
  }

  void noteDensity(const openvdb::GridBase::Ptr& grid) {
    made_.density = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (request_.volume.edge == Edge::kSoft)
      sources_.soft = cropped(*softVoxels(*made_.density, *voxels_.all), sources_.region.grown(1));
  }

  openvdb::Int32Grid::Ptr parts() {
    if (made_.parts) return made_.parts;
    if (request_.spreadsParts()) {
      VolumeSettings hard = request_.volume;
      hard.edge = Edge::kHard;
      sources_.solid =
          made_.density
              ? made_.density
              : openvdb::gridPtrCast<openvdb::FloatGrid>(gridOf(GridKind::kDensity, hard));
    }
    made_.parts =
        openvdb::gridPtrCast<openvdb::Int32Grid>(gridOf(GridKind::kPart, request_.volume));
    return made_.parts;
  }

  const Request& request_;
  PreparedScene& prepared_;
  Progress& progress_;
  ConvertReport& report_;
  bool marks_;
  double area_;
  MarkedVoxels voxels_;
  openvdb::MaskGrid::Ptr later_;
  GridSources sources_;
  MadeGrids made_;
};

/// The grids of the output: cropped, named, with metadata, and split into parts.
std::vector<openvdb::GridBase::Ptr> finishedGrids(const MadeGrids& made, const Scene& scene,
                                                  const Request& request, PreparedScene& prepared,
                                                  ConvertReport& report) {
  const openvdb::MetaMap metadata = describe(scene, request, report);
  std::vector<openvdb::GridBase::Ptr> grids;
  if (made.parts) cropGrid(*made.parts, prepared.region);
  for (std::size_t i = 0; i < made.asked.size(); ++i) {
    cropGrid(*made.asked[i], prepared.region);
    const openvdb::GridBase::Ptr grid =
        finished(made.asked[i], request.grids[i], request.volume, metadata, report.warnings);
    if (request.part) {
      grid->insertMeta(kRunPartMetadata, openvdb::Int32Metadata(request.part->number));
      grid->insertMeta(kRunPartsMetadata, openvdb::Int32Metadata(request.part->count));
    }
    if (grid == made.parts)
      grid->insertMeta(kPartsMetadata, openvdb::StringMetadata(partsJson(prepared.partNames)));
    if (grid != made.density || !request.splits || made.density->activeVoxelCount() == 0) {
      grids.push_back(grid);
      continue;
    }
    for (const auto& part : splitByParts(*made.density, made.parts->tree(), prepared.partNames,
                                         prepared.budget, report.warnings))
      grids.push_back(part);
  }
  // OpenVDB rounds when it copies a transform that moves.
  if (const auto& origin = request.resolution.origin; origin && !origin->isZero(0))
    for (const auto& grid : grids) grid->setTransform(transformOfFile(request, prepared.transform));
  return grids;
}

/// @param usedUp  as in prepareScene
Conversion convertScene(const Scene& scene, const Request& request, Progress& progress,
                        Scene* usedUp = nullptr) {
  openvdb::initialize();
  Conversion result;
  ConvertReport& report = result.report;
  PreparedScene prepared = prepareScene(scene, request, progress, report, usedUp);
  if (!prepared.estimate.refusal.empty()) throw LimitError(prepared.estimate.refusal);
  GridMaker maker(request, prepared, progress, report);
  const StageTimer timer(report.gridsSeconds);
  result.grids = finishedGrids(maker.make(), scene, request, prepared, report);
  result.compression = request.volume.compression;
  if (!request.part && (request.crops() || request.volume.alpha == Alpha::kCut))
    warnOfEmpty(result, request, report);
  if (!needsVoxels(request.grids)) report.activeVoxels = result.grids[0]->activeVoxelCount();
  return result;
}

Estimate estimateScene(const Scene& scene, const Request& request, Progress& progress,
                       std::vector<std::string>& warnings) {
  ConvertReport report;
  const PreparedScene prepared = prepareScene(scene, request, progress, report);
  warnings = report.warnings;
  Estimate estimate = prepared.estimate;
  if (!estimate.refusal.empty()) return estimate;
  for (const PreparedSurface& surface : prepared.surfaces)
    estimate.levels = std::max(estimate.levels, levelsOf(surface, progress));
  return estimate;
}

/// Checks the meshes, and runs work(progress) on the threads asked for.
template <class Work>
auto runRequest(const Scene& scene, const RunOptions& run, Work&& work) {
  requireValidScene(scene);
  Progress unwatched;
  Progress& progress = run.progress != nullptr ? *run.progress : unwatched;
  return onThreads(run.threads, [&] { return work(progress); });
}

}  // namespace

Box boxOf(const Scene& scene, std::span<const ObjectPreparation> preparations) {
  Box box;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    box.add(keptBox(scene, scene.objects[i], preparations[i]));
  return box;
}

Conversion convert(const Scene& scene, const ConvertOptions& options) {
  return convert(scene, resolve(scene, options));
}

Conversion convert(const Scene& scene, const Request& request) {
  return runRequest(scene, request.run,
                    [&](Progress& progress) { return convertScene(scene, request, progress); });
}

Conversion convert(Scene&& scene, const Request& request) {
  return runRequest(scene, request.run, [&](Progress& progress) {
    return convertScene(scene, request, progress, &scene);
  });
}

Estimate estimate(const Scene& scene, const ConvertOptions& options,
                  std::vector<std::string>& warnings) {
  return estimate(scene, resolve(scene, options), warnings);
}

Estimate estimate(const Scene& scene, const Request& request, std::vector<std::string>& warnings) {
  return runRequest(scene, request.run, [&](Progress& progress) {
    return estimateScene(scene, request, progress, warnings);
  });
}

std::vector<std::string> namesOf(const Conversion& conversion) {
  std::vector<std::string> names;
  for (const auto& grid : conversion.grids) names.push_back(grid->getName());
  return names;
}

std::vector<std::uint64_t> memoryOf(const Conversion& conversion) {
  std::vector<std::uint64_t> bytes;
  for (const auto& grid : conversion.grids) bytes.push_back(grid->memUsage());
  return bytes;
}

namespace {

/// @param name  of the file, for its format
void writeAs(const std::filesystem::path& name, std::iostream& stream, const Conversion& conversion,
             Progress* progress) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  for (const auto& grid : conversion.grids)
    for (const char* key : {kGainMetadata, kEdgeMetadata})
      if (const auto value = (*grid)[key]) metadata.insertMeta(key, *value);
  if (progress == nullptr)
    return writeGridFile(stream, name, conversion.grids, metadata, conversion.compression);
  progress->beginLast("write");
  WatchedStream watched(*stream.rdbuf(), *progress, expectedBytes(conversion.grids));
  writeGridFile(watched, name, conversion.grids, metadata, conversion.compression);
}

}  // namespace

void writeGrids(std::iostream& stream, const Conversion& conversion, Progress* progress) {
  writeAs(".vdb", stream, conversion, progress);
}

void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite,
                Progress* progress) {
  AtomicFile output(file, overwrite);
  writeAs(file, output.stream(), conversion, progress);
  if (progress != nullptr) progress->check();
  output.commit();
}

}  // namespace vox
