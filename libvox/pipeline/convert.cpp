// The whole conversion: the only place that knows every stage.

#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/version.h"
#include "libvox/grid/transform.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/write_vdb.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/volume/density.h"

#include <Eigen/Geometry>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>

namespace vox {
namespace {

/// Adds the time of a scope to a total.
class StageTimer {
 public:
  explicit StageTimer(double& total) : total_(total) {}
  ~StageTimer() {
    total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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

void requireStopRules(const Scene& scene, const ConvertOptions& options) {
  for (const SceneObject& object : scene.objects) {
    const StopRule until = stopRuleOf(object, scene, options);
    if (until.levels && (*until.levels < 0 || *until.levels > kMostLevels))
      throw UsageError("the number of levels must lie between 0 and " +
                       std::to_string(kMostLevels) + ", not " + std::to_string(*until.levels));
    if (!until.levels && options.separation == Separation::k26)
      throw UsageError(object.name +
                       ": --separating 26 needs polygons; give --until levels=K with it");
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

/// Area of the faces as fans, in square voxels.
double areaOf(const PolygonMesh& mesh) {
  double twice = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      twice += (mesh.points[face[i]] - mesh.points[face[0]])
                   .cross(Vec3d(mesh.points[face[i + 1]] - mesh.points[face[0]]))
                   .norm();
  }
  return twice / 2;
}

/// Bytes of mask nodes for a surface: 1.5 leaves per 64 square voxels, averaged over directions,
/// and 1.5 inner nodes per 16384.
double bytesOfMask(double area) {
  using Leaf = openvdb::MaskTree::LeafNodeType;
  using Lower = openvdb::MaskTree::RootNodeType::ChildNodeType::ChildNodeType;
  return 1.5 * area * (sizeof(Leaf) / 64.0 + sizeof(Lower) / 16384.0);
}

/// Refuses a surface that cannot fit, before the work starts, and says which resolution would. The
/// area of the control mesh is more than that of the surface, but less than twice for most.
void requireMaskFits(const PolygonMesh& controlMesh, const GridTransform& transform,
                     double longestSide, const MemoryBudget& budget) {
  const double bytes = bytesOfMask(areaOf(controlMesh));
  constexpr double kCertain = 4;
  const double left = static_cast<double>(budget.left());
  if (bytes <= kCertain * left) return;
  const double larger = std::sqrt(kCertain * bytes / left) * transform.voxelSize;
  std::ostringstream advice;
  advice.precision(3);
  advice << "use --dim " << std::max(1.0, std::floor(longestSide / larger)) << " or --voxel-size "
         << larger << ", or raise --max-memory";
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
  requireInRange(usedBox(prepared.base.mesh), transform);
}

/// What became of a surface, for the report.
void noteSurface(const SurfaceReport& surface, ObjectReport& part) {
  part.submeshes = surface.submeshes;
  for (std::size_t level = 0; level < surface.vertices.size(); ++level) {
    if (surface.vertices[level] == 0) continue;
    part.levels = static_cast<int>(level);
    part.vertices += surface.vertices[level];
  }
}

/// Polygon conversion of an object, with a warning if its polygons are not what they should be.
void convertPolygons(PreparedObject prepared, int levels, Separation separation,
                     const MemoryBudget& budget, SurfaceGrid& grid, ObjectReport& part,
                     std::vector<std::string>& warnings) {
  markPolygons(std::move(prepared.base), levels, separation, budget, grid, part.polygons);
  part.levels = levels;
  const std::uint64_t fanned = part.polygons.fanned;
  if (fanned > 0)
    warnings.push_back(part.name + ": " + std::to_string(fanned) +
                       (fanned == 1 ? " polygon is" : " polygons are") +
                       " folded or without area and became " + (fanned == 1 ? "a fan" : "fans") +
                       " of triangles");
}

openvdb::MaskGrid::Ptr convertObjects(const Scene& scene, const ConvertOptions& options,
                                      const GridTransform& transform, double longestSide,
                                      MemoryBudget& budget, ConvertReport& report) {
  SurfaceGrid grid(budget.left());
  for (const SceneObject& object : scene.objects) {
    ObjectReport& part = report.objects.emplace_back();
    part.name = object.name;
    part.inputFaces = object.mesh.faceCount();
    const StopRule until = stopRuleOf(object, scene, options);
    PreparedObject prepared;
    {
      const StageTimer timer(report.prepareSeconds);
      prepared = prepare(scene, object, options, budget);
      if (until.levels != 0) warnOfBoundary(part.name, prepared.base, report);
      notePreparation(prepared, transform, part, report);
      moveToIndexSpace(prepared.base.mesh, transform);
      requireMaskFits(prepared.base.mesh, transform, longestSide, budget);
    }
    const StageTimer timer(report.surfaceSeconds);
    if (until.levels) {
      convertPolygons(std::move(prepared), *until.levels, options.separation, budget, grid, part,
                      report.warnings);
      continue;
    }
    SurfaceReport surface;
    markSurface(prepared.base, options.surface, grid, surface);
    noteSurface(surface, part);
  }
  budget.take(grid.memoryBytes(), "the grid", kScattered);
  auto mask = openvdb::MaskGrid::create(grid.takeTree());
  mask->setName(gridName(GridKind::kMask));
  mask->setTransform(openvdb::math::Transform::createLinearTransform(transform.voxelSize));
  report.activeVoxels = mask->activeVoxelCount();
  return mask;
}

Conversion convertScene(const Scene& scene, const ConvertOptions& options) {
  openvdb::initialize();
  Conversion result;
  MemoryBudget budget(options.run.maxMemory);
  for (const SceneObject& object : scene.objects)
    budget.take(bytesOf(object.mesh), "the input", "raise --max-memory");

  const Box box = boxOf(scene);
  const GridTransform transform = chooseTransform(box, scene, options);
  result.report.voxelSize = transform.voxelSize;
  const openvdb::MaskGrid::Ptr mask =
      convertObjects(scene, options, transform, box.longestSide(), budget, result.report);

  const openvdb::MetaMap metadata = describe(scene, options, transform, result.report);
  const std::vector<GridKind> kinds =
      options.grids.value_or(scene.grids.value_or(std::vector{GridKind::kDensity}));
  for (const GridKind kind : kinds) {
    openvdb::GridBase::Ptr grid = makeGrid(kind, mask, budget);
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
  return onThreads(options.run.threads, [&] { return convertScene(scene, options); });
}

void writeGrids(std::iostream& stream, const Conversion& conversion) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  writeVdb(stream, conversion.grids, metadata);
}

void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite) {
  AtomicFile output(file, overwrite);
  writeGrids(output.stream(), conversion);
  output.commit();
}

}  // namespace vox
