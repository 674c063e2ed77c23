// Normals of polygons to voxels: paper section 8.

#include "libvox/pipeline/normals.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/pipeline/vertex_normals.h"
#include "libvox/voxelize/blended_triangle.h"
#include "libvox/voxelize/scan.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <span>
#include <vector>

namespace vox {
namespace {

/// Adds the normals of polygons to the means; one for each thread.
class NormalSink : public PolygonSink {
 public:
  explicit NormalSink(VoxelMeans& means) : writer_(means) {}

  bool wantsNormals() const override { return true; }

  /// Faces of a smooth surface: normals are blended.
  void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) override {
    triangulate(piece, 0, piece.faceCount());
    BlendedTriangle triangle;
    Index last = kNone;
    scanTriangles(piece.points, triangles_, Separation::k26, [&](const VoxelBlock& block) {
      if (block.triangle != last) triangle = blended(piece, normals, block.triangle);
      last = block.triangle;
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        writer_.add({x, y, z}, triangle.normalNear(Vec3d(x, y, z)));
      });
    });
  }

  /// Flat faces.
  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangulate(mesh, begin, end);
    scanTriangles(mesh.points, triangles_, Separation::k26, [this](const VoxelBlock& block) {
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        writer_.add({x, y, z}, normals_[block.triangle]);
      });
    });
  }

 private:
  BlendedTriangle blended(const PolygonMesh& piece, std::span<const Vec3d> normals,
                          Index triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    return {{piece.points[a], piece.points[b], piece.points[c]},
            {normals[a], normals[b], normals[c]},
            normals_[triangle]};
  }

  void triangulate(const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    normals_.clear();
    for (Index f = begin; f != end; ++f) addTriangles(mesh, f);
  }

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
  std::vector<Vec3d> normals_;                   // of their polygons
};

}  // namespace

void addNormals(const SubdivisionLevel& base, const ConversionWay& way,
                const SurfaceOptions& options, Progress& progress, VoxelMeans& means) {
  if (!way.polygons) return addNormalsOfVertices(base, progress, means);
  tbb::enumerable_thread_specific<NormalSink> sinks([&] { return NormalSink(means); });
  if (way.until.levels == 0) {
    constexpr std::size_t kFacesPerPart = 64;
    parallelForRanges(
        base.mesh.faceCount(), kFacesPerPart, [&](std::size_t begin, std::size_t end) {
          progress.check();
          sinks.local().faces(base.mesh, static_cast<Index>(begin), static_cast<Index>(end));
        });
    return;
  }
  const PolygonPlan plan = planPolygons(base, way.until, options, progress);
  makePolygons(plan, progress, [&]() -> PolygonSink& { return sinks.local(); });
}

}  // namespace vox
