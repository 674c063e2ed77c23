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
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/volume/density.h"
#include "libvox/voxelize/vertex.h"

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

// Depth

/// Doo-Sabin levels still to do when faces of a span halve with each.
int levelsToGo(double span) {
  return span <= kVertexConversionSpan
             ? 0
             : static_cast<int>(std::ceil(std::log2(span / kVertexConversionSpan)));
}

/// Bytes at the deepest moment when `levels` more are done: the points of the last level, which has
/// no topology, and the level before it.
double bytesAtDepth(const SubdivisionLevel& level, int levels) {
  constexpr double kBytesPerPoint = sizeof(Vec3d);
  constexpr double kBytesPerVertex = kBytesPerPoint + 4 * 4 * sizeof(Index);  // with four corners
  const double points = static_cast<double>(nextPointCount(level)) * std::pow(4.0, levels);
  return points * kBytesPerPoint + points / 4 * kBytesPerVertex;
}

/// Refuses a conversion that cannot fit before its first expensive level, and says what would.
void requireFitsAtFullDepth(const SubdivisionLevel& level, double span, double voxelSize,
                            double longestSide, const MemoryBudget& budget) {
  const int toGo = levelsToGo(span);
  int fit = toGo;
  while (fit > 0 && bytesAtDepth(level, fit) > static_cast<double>(budget.left())) --fit;
  if (fit == toGo) return;
  constexpr double kMargin = 1.5;  // faces may shrink by less than half at first
  const double larger = kMargin * span / kVertexConversionSpan / std::pow(2.0, fit) * voxelSize;
  std::ostringstream advice;
  advice.precision(3);
  advice << "use --dim " << std::max(1.0, std::floor(longestSide / larger)) << " or --voxel-size "
         << larger << ", or raise --max-memory";
  constexpr double kMostBytes = 1e18;
  budget.require(static_cast<std::uint64_t>(std::min(bytesAtDepth(level, toGo), kMostBytes)),
                 "subdividing the whole mesh to voxel size", advice.str());
}

/// Subdivides until every face is small enough for vertex conversion and returns the vertices of
/// the last level, in voxels. At least one level: the points of the input are not on the surface.
std::vector<Vec3d> verticesAtVoxelSize(SubdivisionLevel level, double voxelSize, double longestSide,
                                       const MemoryBudget& budget, ObjectReport& report) {
  constexpr const char* kAdvice = "use larger voxels, or raise --max-memory";
  for (;;) {
    const std::uint64_t held = bytesOf(level) + bytesOfImage(level);
    budget.require(held, "subdivision", kAdvice);
    std::vector<Vec3d> image = imageVertices(level);
    ++report.levels;
    report.vertices = image.size();
    report.largestSpan = largestChildSpan(level, image);
    if (report.largestSpan <= kVertexConversionSpan) return image;
    requireFitsAtFullDepth(level, report.largestSpan, voxelSize, longestSide, budget);
    budget.require(held + bytesOfNextTopology(level), "subdivision", kAdvice);
    level = nextLevel(level, std::move(image));
  }
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

// Memory of grids

template <class TreeT>
std::uint64_t bytesOfTree(const TreeFootprint& footprint, std::size_t bytesPerVoxel) {
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  return footprint.leaves * (sizeof(Leaf) + Leaf::SIZE * bytesPerVoxel) +
         footprint.lowerNodes * sizeof(Lower) + footprint.upperNodes * sizeof(Upper);
}

constexpr const char* kScattered =
    "the model is scattered over much space: use larger voxels, or raise --max-memory";

void mark(const std::vector<Vec3d>& vertices, openvdb::MaskGrid& mask, MemoryBudget& budget) {
  TreeFootprint footprint = footprintOf(vertices);
  // Threads may need a node at the same place each, until their trees are merged.
  footprint.lowerNodes *= 2;
  footprint.upperNodes *= 2;
  budget.take(bytesOfTree<openvdb::MaskTree>(footprint, 0), "the grid", kScattered);
  markVertices(vertices, mask);
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
  return text.str();
}

openvdb::MetaMap describe(const Scene& scene, const ConvertOptions& options,
                          const GridTransform& transform, const ConvertReport& report) {
  int levels = 0;
  for (const ObjectReport& object : report.objects) levels = std::max(levels, object.levels);
  const auto voxels = static_cast<openvdb::Int64>(report.activeVoxels);
  openvdb::MetaMap metadata;
  metadata.insertMeta("vox_version", openvdb::StringMetadata(version()));
  if (!scene.files.empty()) {
    metadata.insertMeta("vox_input", openvdb::StringMetadata(scene.files[0].filename().string()));
    metadata.insertMeta("vox_input_hash", openvdb::StringMetadata(scene.inputHash));
  }
  metadata.insertMeta("vox_options",
                      openvdb::StringMetadata(optionText(transform, scene, options)));
  metadata.insertMeta("vox_levels", openvdb::Int32Metadata(levels));
  metadata.insertMeta("vox_guarantee", openvdb::StringMetadata("6-separating"));
  metadata.insertMeta("vox_active_voxels", openvdb::Int64Metadata(voxels));
  return metadata;
}

openvdb::GridBase::Ptr makeGrid(GridKind kind, const openvdb::MaskGrid::Ptr& mask,
                                MemoryBudget& budget) {
  if (kind == GridKind::kMask) return mask;
  const auto nodes = mask->tree().nodeCount();  // leaves first, root last
  budget.take(bytesOfTree<openvdb::FloatTree>({nodes[0], nodes[1], nodes[2]}, sizeof(float)),
              "the density grid", kScattered);
  return densityGrid(*mask);
}

/// Notes what preparation did, and refuses vertices that it moved out of the range of the grid.
void notePreparation(const PreparedObject& prepared, const GridTransform& transform,
                     ObjectReport& part, ConvertReport& report) {
  part.interpolation = prepared.interpolation;
  report.warnings.insert(report.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
  warnOfBoundary(part.name, prepared.base, report);
  requireInRange(usedBox(prepared.base.mesh), transform);
}

openvdb::MaskGrid::Ptr convertObjects(const Scene& scene, const ConvertOptions& options,
                                      const GridTransform& transform, double longestSide,
                                      MemoryBudget& budget, ConvertReport& report) {
  auto mask = openvdb::MaskGrid::create();
  mask->setName(gridName(GridKind::kMask));
  mask->setTransform(openvdb::math::Transform::createLinearTransform(transform.voxelSize));
  for (const SceneObject& object : scene.objects) {
    ObjectReport& part = report.objects.emplace_back();
    part.name = object.name;
    part.inputFaces = object.mesh.faceCount();
    std::vector<Vec3d> vertices;
    {
      const StageTimer timer(report.subdivideSeconds);
      PreparedObject prepared = prepare(scene, object, options, budget);
      notePreparation(prepared, transform, part, report);
      moveToIndexSpace(prepared.base.mesh, transform);
      vertices = verticesAtVoxelSize(std::move(prepared.base), transform.voxelSize, longestSide,
                                     budget, part);
    }
    const StageTimer timer(report.voxelizeSeconds);
    mark(vertices, *mask, budget);
  }
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
