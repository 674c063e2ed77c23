// The smooth surface as few polygons: one global level, its vertices halfway to the surface.

#include "libvox/pipeline/few_polygons.h"

#include "libvox/options/stop_rule.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/image_vertices.h"

#include <utility>
#include <vector>

namespace vox {
namespace {

/// The limit of every point: the mean of its image vertices.
/// @param mesh  of level 1 or deeper
std::vector<Vec3d> limitPoints(const PolygonMesh& mesh, const std::vector<Vec3d>& image) {
  std::vector<Vec3d> limits(mesh.points.size(), Vec3d::Zero());
  std::vector<Index> counts(mesh.points.size(), 0);
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    limits[mesh.faceVertices[c]] += image[c];
    ++counts[mesh.faceVertices[c]];
  }
  for (std::size_t v = 0; v < limits.size(); ++v)
    limits[v] = counts[v] > 0 ? Vec3d(limits[v] / counts[v]) : mesh.points[v];
  return limits;
}

void moveHalfway(PolygonMesh& mesh, const std::vector<Vec3d>& limits) {
  for (std::size_t v = 0; v < limits.size(); ++v) mesh.points[v] = (mesh.points[v] + limits[v]) / 2;
}

}  // namespace

std::optional<PolygonMesh> fewPolygons(const SubdivisionLevel& base, std::optional<int> levels) {
  constexpr Index kEnoughCorners = 10000;
  const int most = levels.value_or(kMostLevels);
  if (most == 0 || base.mesh.cornerCount() > kEnoughCorners) return std::nullopt;
  SubdivisionLevel level = base;
  int k = 0;
  do {
    level = nextLevel(level, imageVertices(level));
    ++k;
  } while (k < most && level.mesh.cornerCount() <= kEnoughCorners);
  if (!levels) moveHalfway(level.mesh, limitPoints(level.mesh, imageVertices(level)));
  return std::move(level.mesh);
}

}  // namespace vox
