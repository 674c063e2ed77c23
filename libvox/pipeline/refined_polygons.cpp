// The smooth surface as few polygons: one global level, its vertices halfway to the surface.

#include "libvox/pipeline/refined_polygons.h"

#include "libvox/core/parallel.h"
#include "libvox/mesh/stop_rule.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/image_vertices.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace vox {
namespace {

constexpr std::size_t kElementsPerTask = 1024;
constexpr const char* kAdvice = "use a larger --tolerance or larger voxels, or raise --max-memory";

/// Of every point, its limit: the mean of its image vertices. Of level 1 and more.
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

/// Distance between the middles of the two diagonals of a quad, halved: from the middle of either
/// to the centroid, which is on the surface.
double twist(const PolygonMesh& mesh, Index f) {
  const auto face = mesh.face(f);
  if (face.size() != 4) return 0;
  const auto& p = mesh.points;
  return (p[face[0]] - p[face[1]] + p[face[2]] - p[face[3]]).norm() / 4;
}

/// How far the polygons of a level lie from the surface, at most, once its vertices have gone
/// halfway to their limits.
double errorOf(const PolygonMesh& mesh, const std::vector<Vec3d>& limits) {
  const double atVertices =
      maxOverParts(mesh.pointCount(), kElementsPerTask, [&](std::size_t begin, std::size_t end) {
        double largest = 0;
        for (std::size_t v = begin; v != end; ++v)
          largest = std::max(largest, (mesh.points[v] - limits[v]).norm() / 2);
        return largest;
      });
  const double twisted =
      maxOverParts(mesh.faceCount(), kElementsPerTask, [&](std::size_t begin, std::size_t end) {
        double largest = 0;
        for (std::size_t f = begin; f != end; ++f)
          largest = std::max(largest, twist(mesh, static_cast<Index>(f)));
        return largest;
      });
  return std::max(atVertices, twisted);
}

}  // namespace

PolygonMesh trianglesAndQuads(PolygonMesh mesh) {
  PolygonMesh cut;
  cut.points = std::move(mesh.points);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    if (face.size() <= 4) {
      cut.addFace(face);
      continue;
    }
    Vec3d centroid = Vec3d::Zero();
    for (const Index v : face) centroid += cut.points[v];
    const Index centre = cut.pointCount();
    cut.points.push_back(centroid / static_cast<double>(face.size()));
    for (std::size_t i = 0; i < face.size(); ++i)
      cut.addFace(std::array{face[i], face[(i + 1) % face.size()], centre});
  }
  return cut;
}

PolygonMesh refinedPolygons(SubdivisionLevel base, double tolerance, const MemoryBudget& budget,
                            const Progress& progress) {
  SubdivisionLevel level = std::move(base);
  for (int k = 0;; ++k) {
    progress.check();
    budget.require(bytesOf(level) + 2 * bytesOfImage(level) + bytesOfNextTopology(level),
                   "level " + std::to_string(k + 1) + " of the polygons", kAdvice);
    std::vector<Vec3d> image = imageVertices(level);
    if (k == 0) {  // an extended boundary begins at level 1
      level = nextLevel(level, std::move(image));
      continue;
    }
    const std::vector<Vec3d> limits = limitPoints(level.mesh, image);
    if (errorOf(level.mesh, limits) <= tolerance || k == kMostLevels) {
      for (std::size_t v = 0; v < limits.size(); ++v)
        level.mesh.points[v] = (level.mesh.points[v] + limits[v]) / 2;
      return trianglesAndQuads(std::move(level.mesh));
    }
    level = nextLevel(level, std::move(image));
  }
}

}  // namespace vox
