// Compares voxels with the surface that they were made from.

#include "apps/vox/verify.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/inspect/lint.h"
#include "libvox/inspect/topology.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/subdivide/stop.h"
#include "libvox/volume/joined_parts.h"

#include <algorithm>
#include <optional>

namespace vox::app {
namespace {

bool hasFacesWithin(const PolygonMesh& mesh, double span) {
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    if (diameter(corners) > span) return false;
  }
  return true;
}

/// The smooth surface, made again in another way: the whole mesh at once, by the plain algorithm.
ReferenceSurface smoothReference(SubdivisionLevel level, const MemoryBudget& budget,
                                 Progress& progress) {
  while (!hasFacesWithin(level.mesh, kVertexConversionSpan))
    level = subdividedWithin(budget, std::move(level), 1, progress);
  // The conversion may stop some levels earlier, at faces as small as a voxel. Second differences
  // of their control points are at most 2 voxels, so the surface is within 2/8 voxels of them.
  constexpr double kTolerance = 0.25;
  return referenceSurface(std::move(level.mesh), kTolerance);
}

/// Looks for tunnels of polygons that stop at different levels, in two ways. The voxels are
/// compared with these polygons, made again: that finds voxels that were not marked. And with a
/// level of the whole mesh, by the plain algorithm: that finds gaps of the polygons, at which the
/// two kinds of polygons are as far apart as anywhere.
SeparationReport findTunnelsOfLimits(const openvdb::MaskTree& voxels, SubdivisionLevel level,
                                     const StopRule& until, const Request& request,
                                     const MemoryBudget& budget, Progress& progress) {
  constexpr double kFineEnough = 4;  // the smooth surface is within a quarter of it
  TriangleSoup soup = triangleSoup(level, until, request.surface, progress);
  const ReferenceSurface polygons{std::move(soup.points), std::move(soup.triangles), 0};
  const SeparationReport report = findTunnels(voxels, polygons, request.separation);
  const int most = until.levels.value_or(kMostLevels);
  for (int k = 0; k < most && !hasFacesWithin(level.mesh, kFineEnough); ++k)
    level = subdividedWithin(budget, std::move(level), 1, progress);
  ReferenceSurface plain = referenceSurface(std::move(level.mesh), 0);
  const std::optional<int> reach = reachOf(plain, polygons);
  if (!reach || report.tunnels > 0) return report;  // too coarse to compare, or faulty already
  plain.tolerance = std::max(1, *reach);
  return findTunnels(voxels, plain, Separation::k6);
}

SeparationReport tunnelsOf(const openvdb::MaskTree& voxels, const Scene& scene,
                           const Request& request, std::size_t i, const GridTransform& transform,
                           const MemoryBudget& budget, Progress& progress) {
  const ObjectRequest& object = request.objects[i];
  SubdivisionLevel level =
      std::move(prepare(scene, scene.objects[i], object.preparation, budget, progress).base);
  for (Vec3d& point : level.mesh.points) point = transform.toIndex(point);
  const ConversionWay& way = object.way;
  const bool uniform = way.until == StopRule{.levels = way.until.levels};
  if (way.polygons && !uniform)
    return findTunnelsOfLimits(voxels, std::move(level), way.until, request, budget, progress);
  const ReferenceSurface surface =
      way.polygons
          ? referenceSurface(
                subdividedWithin(budget, std::move(level), *way.until.levels, progress).mesh, 0)
          : smoothReference(std::move(level), budget, progress);
  return findTunnels(voxels, surface, request.separation);
}

}  // namespace

std::vector<ObjectCheck> checkObjects(const openvdb::MaskTree& voxels, const Scene& scene,
                                      const Request& request, double voxelSize) {
  Progress unwatched;
  Progress& progress = request.run.progress != nullptr ? *request.run.progress : unwatched;
  const MemoryBudget budget(request.run.maxMemory);
  const GridTransform transform = placedFor(request, transformForVoxelSize(voxelSize));
  std::vector<ObjectCheck> checks;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    checks.push_back(
        {scene.objects[i].name, tunnelsOf(voxels, scene, request, i, transform, budget, progress)});
    progress.check();
  }
  return checks;
}

void verify(const Conversion& conversion, const Scene& scene, const Request& request) {
  if (request.part) throw UsageError("--verify needs the whole surface: leave it out, or --part");
  if (request.crops())
    throw UsageError("--verify needs the whole surface: leave it out, or --bounds and --clip");
  if (request.volume.alpha == Alpha::kCut)
    throw UsageError("--verify needs the whole surface: leave it out, or --alpha cut");
  openvdb::MaskTree::Ptr voxels;
  for (const auto& grid : conversion.grids) {
    for (const LintFinding& finding : lintGrid(*grid))
      if (finding.isFault) throw CheckFailed("--verify: " + finding.grid + " " + finding.message);
    for (const GridKind kind : {GridKind::kMask, GridKind::kDensity})
      if (!voxels && grid->getName() == nameIn(kGridNames, kind)) voxels = topologyOf(*grid);
  }
  if (const auto parts = joinedParts(conversion.grids); parts && !voxels) voxels = parts->treePtr();
  if (!voxels) throw UsageError("--verify needs a mask or density grid; name one in --grids");
  for (const ObjectCheck& object :
       checkObjects(*voxels, scene, request, conversion.report.voxelSize))
    if (object.separation.tunnels > 0)
      throw CheckFailed("--verify: " + object.name + ": " + separationText(object.separation));
}

std::string separationText(const SeparationReport& report) {
  if (report.tunnels == 0) return "no tunnels";
  std::string text =
      std::to_string(report.tunnels) + (report.tunnels == 1 ? " tunnel" : " tunnels");
  if (!report.first) return text;
  const auto& [x, y, z] = *report.first;
  return text + ", the first at (" + std::to_string(x) + ' ' + std::to_string(y) + ' ' +
         std::to_string(z) + ')';
}

}  // namespace vox::app
