// Announces the work of a conversion to its progress.

#include "libvox/pipeline/plan.h"

#include "libvox/core/progress.h"
#include "libvox/mesh/area.h"
#include "libvox/pipeline/work.h"

namespace vox {
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
    for (const GridKind kind : request.grids)
      progress.plan(workOfGrid(kind, request.volume.edge, areas[i]) +
                    workOfWriting(kind, areas[i]));
  }
}

}  // namespace vox
