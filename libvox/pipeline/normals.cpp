// Normals of polygons to voxels: paper section 8.

#include "libvox/pipeline/normals.h"

#include "libvox/core/parallel.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/voxelize/scan.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vox {
namespace {

/// One thread's way from polygons to means.
class NormalSink : public PolygonSink {
 public:
  explicit NormalSink(VoxelMeans& means) : writer_(means) {}

  void polygons(const PolygonMesh& piece) override { faces(piece, 0, piece.faceCount()); }

  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    normals_.clear();
    for (Index f = begin; f != end; ++f) addTriangles(mesh, f);
    scanTriangles(mesh.points, triangles_, Separation::k26, [this](const VoxelBlock& block) {
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        writer_.add({x, y, z}, normals_[block.triangle]);
      });
    });
  }

 private:
  void addTriangles(const PolygonMesh& mesh, Index f) {
    const auto face = mesh.face(f);
    const Vec3d normal =
        twiceAreaVector(face.size(), [&](std::size_t i) { return mesh.points[face[i]]; });
    if (normal.isZero(0)) return;
    faces_.add(mesh, f, triangles_);
    normals_.resize(triangles_.size(), normal.normalized());
  }

  VoxelMeans::Writer writer_;
  FaceTriangulator faces_;
  std::vector<std::array<Index, 3>> triangles_;  // of a piece
  std::vector<Vec3d> normals_;                   // of these
};

}  // namespace

void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means) {
  tbb::enumerable_thread_specific<NormalSink> sinks([&] { return NormalSink(means); });
  if (way.polygons && way.until.levels == 0) {
    constexpr std::size_t kFacesPerPart = 64;
    forParts(base.mesh.faceCount(), kFacesPerPart, [&](std::size_t begin, std::size_t end) {
      progress.check();
      sinks.local().faces(base.mesh, static_cast<Index>(begin), static_cast<Index>(end));
    });
    return;
  }
  StopRule voxel;
  voxel.diameter = 1;
  const PolygonPlan plan =
      planPolygons(base, way.polygons ? way.until : voxel, kDefaultSubmeshFaces, progress);
  makePolygons(base, plan, progress, [&]() -> PolygonSink& { return sinks.local(); });
}

}  // namespace vox
