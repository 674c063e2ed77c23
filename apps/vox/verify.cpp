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

namespace vox::app {
namespace {

bool facesFitIntoVoxels(const PolygonMesh& mesh) {
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    if (diameter(corners) > kVertexConversionSpan) return false;
  }
  return true;
}

/// The smooth surface, made again in another way: the whole mesh at once, by the plain algorithm.
ReferenceSurface smoothReference(SubdivisionLevel level, const MemoryBudget& budget,
                                 Progress& progress) {
  while (!facesFitIntoVoxels(level.mesh))
    level = subdividedWithin(budget, std::move(level), 1, progress);
  // The conversion may stop some levels earlier, at faces as small as a voxel. Second differences
  // of their control points are at most 2 voxels, so the surface is within 2/8 voxels of them.
  constexpr double kTolerance = 0.25;
  return referenceSurface(std::move(level.mesh), kTolerance);
}

ReferenceSurface referenceOf(const Scene& scene, const Request& request, std::size_t i,
                             const GridTransform& transform, const MemoryBudget& budget,
                             Progress& progress) {
  const ObjectRequest& object = request.objects[i];
  SubdivisionLevel level =
      std::move(prepare(scene, scene.objects[i], object.preparation, budget, progress).base);
  for (Vec3d& point : level.mesh.points) point = transform.toIndex(point);
  const ConversionWay& way = object.way;
  if (!way.polygons) return smoothReference(std::move(level), budget, progress);
  const bool uniform = way.until == StopRule{.levels = way.until.levels};
  if (uniform)
    return referenceSurface(
        subdividedWithin(budget, std::move(level), *way.until.levels, progress).mesh, 0);
  // Polygons that stop at different levels have no second implementation.
  TriangleSoup soup = triangleSoup(level, way.until, request.surface, progress);
  return {std::move(soup.points), std::move(soup.triangles), 0};
}

}  // namespace

std::vector<ObjectCheck> checkObjects(const openvdb::MaskTree& voxels, const Scene& scene,
                                      const Request& request, double voxelSize) {
  Progress unwatched;
  Progress& progress = request.run.progress != nullptr ? *request.run.progress : unwatched;
  const MemoryBudget budget(request.run.maxMemory);
  GridTransform transform = transformForVoxelSize(voxelSize);
  transform.turn = request.turn;
  std::vector<ObjectCheck> checks;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ReferenceSurface surface = referenceOf(scene, request, i, transform, budget, progress);
    checks.push_back({scene.objects[i].name, findTunnels(voxels, surface, request.separation)});
    progress.check();
  }
  return checks;
}

void verify(const Conversion& conversion, const Scene& scene, const Request& request) {
  openvdb::MaskTree::Ptr voxels;
  for (const auto& grid : conversion.grids) {
    for (const LintFinding& finding : lintGrid(*grid))
      throw CheckFailed("--verify: " + finding.grid + " " + finding.message);
    for (const GridKind kind : {GridKind::kMask, GridKind::kDensity})
      if (!voxels && grid->getName() == nameIn(kGridNames, kind)) voxels = topologyOf(*grid);
  }
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
