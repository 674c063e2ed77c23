// Announces the work of a conversion to its progress.

#include "libvox/pipeline/plan.h"

#include "libvox/core/progress.h"
#include "libvox/mesh/area.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/work.h"

namespace vox {
namespace {

/// Approximate number of voxels of a level set for each voxel of the surface.
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

}  // namespace

std::vector<double> areasOf(const Scene& scene, const GridTransform& transform,
                            const Progress& progress) {
  std::vector<double> areas(scene.objects.size(), 0.0);
  for (std::size_t i = 0; progress.watched() && i < areas.size(); ++i)
    areas[i] = areaOf(scene.objects[i].mesh) / transform.voxelSize / transform.voxelSize;
  return areas;
}

void plan(const Scene& scene, const Request& request, std::span<const double> areas,
          Progress& progress) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const PolygonMesh& mesh = scene.objects[i].mesh;
    progress.plan(workOfPreparing(mesh, request.objects[i].preparation.interpolates()) +
                  workOfSurface(areas[i], mesh.cornerCount()));
    for (const GridKind kind : request.grids) progress.plan(workOfWriting(kind, areas[i]));
  }
  progress.plan(workOfGrids(areas, request.grids, request.volume.edge));
}

}  // namespace vox
