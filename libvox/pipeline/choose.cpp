// Vertices or polygons.

#include "libvox/pipeline/choose.h"

#include "libvox/core/parallel.h"
#include "libvox/localize/partition.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/pipeline/work.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/subdivide/stop.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vox {
namespace {

/// Counts vertices without making them.
class CountingSink : public SurfaceSink {
 public:
  double vertices = 0;  // whole numbers: any order gives the same sum

  void points(std::span<const Vec3d> points, int) override {
    vertices += static_cast<double>(points.size());
  }
  void patch(const Patch&, int k, int) override { vertices += std::ldexp(1.0, 2 * k); }
  void curve(const CurvePoints&, int k, int) override { vertices += std::ldexp(1.0, k); }
};

double countVertices(const SubdivisionLevel& base, Index submeshFaces, const Progress& progress) {
  const Partition partition = coverGreedily(base.mesh, base.adjacency, submeshFaces);
  tbb::enumerable_thread_specific<LocalSurface> surfaces([&] { return LocalSurface(base); });
  tbb::enumerable_thread_specific<CountingSink> sinks;
  forEach(partition.size(), 1, [&](Index s) {
    progress.check();
    surfaces.local().emit(partition.submesh(s), sinks.local());
  });
  double vertices = 0;
  for (const CountingSink& sink : sinks) vertices += sink.vertices;
  return vertices;
}

/// What a mesh looks like from its faces alone.
struct Slenderness {
  double voxels = 0;    ///< rough number of its voxels
  double vertices = 0;  ///< of squares as large as its long faces
};

Slenderness slendernessOf(const PolygonMesh& mesh) {
  constexpr double kLong = 4;  // voxels
  Slenderness slenderness;
  double longest = 0;
  double area = 0;
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    const double size = diameter(corners);
    longest = std::max(longest, size);
    area += areaOf(mesh, f);
    if (size > kLong) slenderness.vertices += static_cast<double>(corners.size()) * size * size / 4;
  }
  constexpr double kVoxelsPerArea = 1.5;  // averaged over directions
  slenderness.voxels = kVoxelsPerArea * area + longest;
  return slenderness;
}

bool polygonsAreFaster(const SubdivisionLevel& base, const StopRule& polygons,
                       const SurfaceOptions& options, const Progress& progress) {
  constexpr double kSuspect = 8;  // vertices per voxel
  const Slenderness slenderness = slendernessOf(base.mesh);
  if (slenderness.vertices <= kSuspect * slenderness.voxels) return false;
  const double vertices = countVertices(base, options.submeshFaces, progress);
  if (vertices <= kMostVerticesPerVoxel * slenderness.voxels) return false;
  return vertices > kVerticesPerPolygonVertex *
                        planPolygons(base, polygons, options.submeshFaces, progress).vertices;
}

}  // namespace

std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation) {
  if (const std::string fault = faultOf(until); !fault.empty()) return fault;
  if (voxelize != Voxelize::kVertex) return {};
  if (!until.untilVoxel())
    return "--voxelize vertex needs --until voxel, not " + stopRuleName(until) +
           "; use --voxelize auto or polygon";
  if (separation == Separation::k26)
    return "--voxelize vertex cannot make 26-separating voxels; use --voxelize auto or polygon";
  return {};
}

ConversionWay chooseWay(const SubdivisionLevel& base, const StopRule& until, Voxelize voxelize,
                        Separation separation, const SurfaceOptions& options,
                        const Progress& progress) {
  if (!until.untilVoxel()) return {true, until, separation};
  if (voxelize == Voxelize::kPolygon) return {true, {.diameter = 1}, separation};
  if (voxelize == Voxelize::kVertex) return {};
  const StopRule flat = {.flatness = kAutomaticFlatness};
  const bool polygons =
      separation == Separation::k26 ||
      (options.localize != Localize::kOff && polygonsAreFaster(base, flat, options, progress));
  if (polygons) return {true, flat, Separation::k26};
  return {};
}

}  // namespace vox
