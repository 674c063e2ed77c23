// Voxels held against the surface they were made from.

#include "apps/vox/verify.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/grid/transform.h"
#include "libvox/inspect/lint.h"
#include "libvox/inspect/topology.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/stop.h"

#include <openvdb/openvdb.h>

namespace vox::app {
namespace {

StopRule stopRuleOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options) {
  for (const auto& said : {options.until, object.until, scene.until})
    if (said) return *said;
  return {};
}

bool facesFitIntoVoxels(const PolygonMesh& mesh) {
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    if (diameter(corners) > kVertexConversionSpan) return false;
  }
  return true;
}

/// The surface again, another way: the whole mesh at once, and by the plain algorithm.
ReferenceSurface referenceOf(const Scene& scene, const SceneObject& object,
                             const ConvertOptions& options, const MemoryBudget& budget,
                             Progress& progress) {
  PreparedObject prepared = prepare(scene, object, options, budget, progress);
  SubdivisionLevel level = std::move(prepared.base);
  GridTransform transform = transformForVoxelSize(*options.voxelSize);
  transform.turn = turnOf(overriding(options.volume, scene.volume));
  for (Vec3d& point : level.mesh.points) point = transform.toIndex(point);
  const StopRule until = stopRuleOf(object, scene, options);
  if (!until.untilVoxel() && until != StopRule{until.levels})
    throw UsageError(object.name +
                     ": only voxels made with --until voxel or levels=K can be held "
                     "against the mesh, not " +
                     stopRuleName(until));
  if (until.levels) {
    level = subdividedWithin(budget, std::move(level), *until.levels, progress);
    return {std::move(level.mesh), std::move(level.adjacency), 0};
  }
  while (!facesFitIntoVoxels(level.mesh))
    level = subdividedWithin(budget, std::move(level), 1, progress);
  // The conversion may stop levels before, at faces as small as a voxel: control points whose
  // second differences are at most 2 voxels, so that the surface is within 2/8 of them.
  constexpr double kTolerance = 0.25;
  return {std::move(level.mesh), std::move(level.adjacency), kTolerance};
}

}  // namespace

std::vector<ObjectCheck> checkObjects(const openvdb::MaskTree& voxels, const Scene& scene,
                                      const ConvertOptions& options) {
  Progress unwatched;
  Progress& progress = options.run.progress != nullptr ? *options.run.progress : unwatched;
  const MemoryBudget budget(options.run.maxMemory);
  std::vector<ObjectCheck> checks;
  for (const SceneObject& object : scene.objects) {
    const ReferenceSurface surface = referenceOf(scene, object, options, budget, progress);
    checks.push_back({object.name, findTunnels(voxels, surface, options.separation)});
    progress.check();
  }
  return checks;
}

void verify(const Conversion& conversion, const Scene& scene, ConvertOptions options) {
  openvdb::MaskTree::Ptr voxels;
  for (const auto& grid : conversion.grids) {
    for (const LintFinding& finding : lintGrid(*grid))
      throw CheckFailed("--verify: " + finding.grid + " " + finding.message);
    for (const GridKind kind : {GridKind::kMask, GridKind::kDensity})
      if (!voxels && grid->getName() == gridName(kind)) voxels = topologyOf(*grid);
  }
  if (!voxels) throw UsageError("--verify needs a mask or density grid; name one in --grids");
  options.voxelSize = conversion.report.voxelSize;
  for (const ObjectCheck& object : checkObjects(*voxels, scene, options))
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
