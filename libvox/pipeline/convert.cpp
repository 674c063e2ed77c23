// The whole conversion: the only place that knows every stage.

#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/hash.h"
#include "libvox/core/memory.h"
#include "libvox/core/version.h"
#include "libvox/grid/transform.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/write_vdb.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/volume/density.h"
#include "libvox/voxelize/vertex.h"

#include <openvdb/openvdb.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>

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

/// Runs work on the number of threads asked for.
template <class Work>
auto onThreads(int threads, Work&& work) {
  if (threads == 0) return work();
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism,
                                 static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(work);
}

std::uint64_t memoryLimit(const ConvertOptions& options) {
  return options.maxMemory != 0 ? options.maxMemory : availableMemory() / 4 * 3;
}

// Bytes per element of a subdivision level, and of the tables that lay out the next one.
constexpr std::uint64_t kBytesPerPoint = sizeof(Vec3d);
constexpr std::uint64_t kBytesPerCorner = 4 * sizeof(Index);  // point, twin, face; offsets, rounded
constexpr std::uint64_t kBytesPerLayoutCorner = 3 * sizeof(Index);

/// Bytes to build the level after this one, whose points exist already.
std::uint64_t bytesForNextLevel(const SubdivisionLevel& level) {
  return level.mesh.cornerCount() * kBytesPerLayoutCorner +
         nextCornerCount(level) * kBytesPerCorner;
}

void requireMemory(std::uint64_t bytes, std::uint64_t limit, const std::string& what,
                   const std::string& advice) {
  if (bytes > limit)
    throw LimitError(what + " needs about " + formatBytes(bytes) + " of memory, the limit is " +
                     formatBytes(limit) + "; " + advice);
}

// Resolution

GridTransform chooseTransform(const Scene& scene, const ConvertOptions& options) {
  Box box;
  for (const SceneObject& object : scene.objects) {
    const Box part = usedBox(object.mesh);
    if (part.empty()) continue;
    box.add(part.low);
    box.add(part.high);
  }
  const bool fromOptions = options.dim || options.voxelSize;
  const auto voxelSize = fromOptions ? options.voxelSize : scene.voxelSize;
  const int dim = (fromOptions ? options.dim : scene.dim).value_or(kDefaultDim);
  const GridTransform transform =
      voxelSize ? transformForVoxelSize(*voxelSize) : transformForDim(box, dim);
  requireInRange(box, transform);
  return transform;
}

PolygonMesh inIndexSpace(PolygonMesh mesh, const GridTransform& transform) {
  for (Vec3d& point : mesh.points) point = transform.toIndex(point);
  return mesh;
}

// Depth

/// Doo-Sabin levels still to do when faces of a span halve with each.
int levelsToGo(double span) {
  return span <= kVertexConversionSpan
             ? 0
             : static_cast<int>(std::ceil(std::log2(span / kVertexConversionSpan)));
}

/// Refuses a conversion that cannot fit before its first expensive level.
void requireFitsAtFullDepth(const SubdivisionLevel& level, double span, std::uint64_t limit) {
  const int toGo = levelsToGo(span);
  const double corners = level.mesh.cornerCount();
  const auto bytesAt = [&](int levels) {
    const double points = corners * std::pow(4.0, levels);  // the last level is points only
    return points * kBytesPerPoint + points / 4 * (kBytesPerPoint + 4 * kBytesPerCorner);
  };
  int fit = toGo;
  while (fit > 0 && bytesAt(fit) > static_cast<double>(limit)) --fit;
  if (fit == toGo) return;
  std::ostringstream advice;
  advice.precision(3);
  advice << "use voxels about " << span / kVertexConversionSpan / std::pow(2.0, fit)
         << " times as large, or raise --max-memory";
  requireMemory(static_cast<std::uint64_t>(std::min(bytesAt(toGo), 1e18)), limit,
                "subdividing the whole mesh to voxel size", advice.str());
}

/// Subdivides until every face is small enough for vertex conversion and returns the vertices of
/// the last level, in voxels. At least one level: the points of the input are not on the surface.
std::vector<Vec3d> verticesAtVoxelSize(PolygonMesh meshIndex, std::uint64_t limit,
                                       ObjectReport& report) {
  SubdivisionLevel level = baseLevel(std::move(meshIndex));
  for (;;) {
    std::vector<Vec3d> image = imageVertices(level.mesh);
    ++report.levels;
    report.vertices = image.size();
    report.largestSpan = largestChildSpan(level, image);
    if (report.largestSpan <= kVertexConversionSpan) return image;
    requireFitsAtFullDepth(level, report.largestSpan, limit);
    level = nextLevel(level, std::move(image));
  }
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
    metadata.insertMeta("vox_input_hash", openvdb::StringMetadata(hashOfFiles(scene.files)));
  }
  metadata.insertMeta("vox_options",
                      openvdb::StringMetadata(optionText(transform, scene, options)));
  metadata.insertMeta("vox_levels", openvdb::Int32Metadata(levels));
  metadata.insertMeta("vox_guarantee", openvdb::StringMetadata("6-separating"));
  metadata.insertMeta("vox_active_voxels", openvdb::Int64Metadata(voxels));
  return metadata;
}

openvdb::GridBase::Ptr makeGrid(GridKind kind, const openvdb::MaskGrid::Ptr& mask) {
  switch (kind) {
    case GridKind::kDensity:
      return densityGrid(*mask);
    case GridKind::kMask:
      return mask;
  }
  return nullptr;
}

Conversion convertOnThisArena(const Scene& scene, const ConvertOptions& options) {
  openvdb::initialize();
  Conversion result;
  ConvertReport& report = result.report;
  const std::uint64_t limit = memoryLimit(options);
  const GridTransform transform = chooseTransform(scene, options);
  report.voxelSize = transform.voxelSize;

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
      vertices = verticesAtVoxelSize(inIndexSpace(object.mesh, transform), limit, part);
    }
    const StageTimer timer(report.voxelizeSeconds);
    markVertices(vertices, *mask);
  }
  report.activeVoxels = mask->activeVoxelCount();

  const openvdb::MetaMap metadata = describe(scene, options, transform, report);
  const std::vector<GridKind> kinds =
      options.grids.value_or(scene.grids.value_or(std::vector{GridKind::kDensity}));
  for (const GridKind kind : kinds) {
    openvdb::GridBase::Ptr grid = makeGrid(kind, mask);
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
      grid->insertMeta(entry->first, *entry->second);
    result.grids.push_back(std::move(grid));
  }
  return result;
}

void append(PolygonMesh& all, const PolygonMesh& part) {
  if (std::uint64_t{all.cornerCount()} + part.cornerCount() >= kNone ||
      std::uint64_t{all.pointCount()} + part.pointCount() >= kNone)
    throw LimitError("the objects together have more elements than fit in 32 bits");
  const Index firstPoint = all.pointCount();
  const Index firstCorner = all.cornerCount();
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (const Index v : part.faceVertices) all.faceVertices.push_back(firstPoint + v);
  for (Index f = 0; f < part.faceCount(); ++f)
    all.faceOffsets.push_back(firstCorner + part.faceOffsets[f + 1]);
}

PolygonMesh refineOnThisArena(const Scene& scene, int levels, const ConvertOptions& options) {
  if (levels < 0) throw UsageError("--levels must be 0 or more, not " + std::to_string(levels));
  const std::uint64_t limit = memoryLimit(options);
  PolygonMesh all;
  for (const SceneObject& object : scene.objects) {
    SubdivisionLevel level = baseLevel(object.mesh);
    for (int k = 0; k < levels; ++k) {
      requireMemory(level.mesh.cornerCount() * kBytesPerPoint + bytesForNextLevel(level), limit,
                    "level " + std::to_string(k + 1),
                    "use --levels " + std::to_string(k) + " or raise --max-memory");
      level = nextLevel(level, imageVertices(level.mesh));
    }
    append(all, level.mesh);
  }
  return all;
}

}  // namespace

Conversion convert(const Scene& scene, const ConvertOptions& options) {
  return onThreads(options.threads, [&] { return convertOnThisArena(scene, options); });
}

PolygonMesh refine(const Scene& scene, int levels, const ConvertOptions& options) {
  return onThreads(options.threads, [&] { return refineOnThisArena(scene, levels, options); });
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
