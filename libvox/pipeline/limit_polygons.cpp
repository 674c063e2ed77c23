// The smooth surface as few polygons: one global level, its vertices halfway to the surface.

#include "libvox/pipeline/limit_polygons.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/options/stop_rule.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/image_vertices.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace vox {
namespace {

constexpr std::size_t kFacesPerTask = 1024;
constexpr const char* kPolygonsAdvice =
    "use a larger --tolerance or larger voxels, or raise --max-memory";

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

/// Area vector of a face (Newell), not normalized.
Vec3d areaVector(const PolygonMesh& mesh, Index f) {
  Vec3d sum = Vec3d::Zero();
  const auto face = mesh.face(f);
  for (std::size_t i = 0; i < face.size(); ++i)
    sum += mesh.points[face[i]].cross(mesh.points[face[(i + 1) % face.size()]]);
  return sum;
}

/// Largest distance of a face from the surface after its vertices have moved halfway to their
/// limits: half of the distance that they had along the normal. For a quad, which is cut in two,
/// also the distance from the middle of a diagonal to the centroid, which is on the surface.
/// Distances along the surface do not count.
double errorOf(const PolygonMesh& mesh, const std::vector<Vec3d>& limits, Index f) {
  const Vec3d area = areaVector(mesh, f);
  const double size = area.norm();
  const Vec3d normal = size > 0 ? Vec3d(area / size) : Vec3d::Zero();
  const auto& p = mesh.points;
  const auto face = mesh.face(f);
  double error = 0;
  for (const Index v : face) error = std::max(error, std::abs(normal.dot(p[v] - limits[v])) / 2);
  if (face.size() != 4) return error;
  const Vec3d twist = p[face[0]] - p[face[1]] + p[face[2]] - p[face[3]];
  return std::max(error, std::abs(normal.dot(twist)) / 4);
}

double errorOf(const PolygonMesh& mesh, const std::vector<Vec3d>& limits) {
  return parallelMax(mesh.faceCount(), kFacesPerTask, [&](std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t f = begin; f != end; ++f)
      largest = std::max(largest, errorOf(mesh, limits, static_cast<Index>(f)));
    return largest;
  });
}

/// Cuts faces of five and more corners into triangles around their centroid.
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

}  // namespace

PolygonMesh limitPolygons(SubdivisionLevel base, double tolerance, const MemoryBudget& budget,
                          const Progress& progress) {
  SubdivisionLevel level = std::move(base);
  for (int k = 0;; ++k) {
    progress.check();
    budget.require(bytesOf(level) + 2 * bytesOfImage(level) + bytesOfNextTopology(level),
                   "level " + std::to_string(k + 1) + " of the polygons", kPolygonsAdvice);
    std::vector<Vec3d> image = imageVertices(level);
    if (k == 0) {  // an extended boundary begins at level 1
      level = nextLevel(level, std::move(image));
      continue;
    }
    const std::vector<Vec3d> limits = limitPoints(level.mesh, image);
    if (errorOf(level.mesh, limits) <= tolerance || k == kMostLevels) {
      moveHalfway(level.mesh, limits);
      return trianglesAndQuads(std::move(level.mesh));
    }
    level = nextLevel(level, std::move(image));
  }
}

PolygonMesh fewPolygons(const SubdivisionLevel& base, std::optional<int> levels) {
  constexpr Index kEnoughCorners = 10000;
  const int most = levels.value_or(kMostLevels);
  if (most == 0 || base.mesh.cornerCount() > kEnoughCorners) return base.mesh;
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
