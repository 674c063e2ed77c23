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

/// One thread's way from polygons to sums.
class NormalSink : public PolygonSink {
 public:
  explicit NormalSink(VoxelSums& sums) : sums_(sums) {}

  void polygons(const PolygonMesh& piece) override { faces(piece, 0, piece.faceCount()); }

  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    normals_.clear();
    for (Index f = begin; f != end; ++f) addTriangles(mesh, f);
    scanTriangles(mesh.points, triangles_, Separation::k26, [this](const VoxelBlock& block) {
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        add({x, y, z}, normals_[block.triangle]);
      });
    });
  }

 private:
  void addTriangles(const PolygonMesh& mesh, Index f) {
    const auto face = mesh.face(f);
    corners_.clear();
    for (const Index v : face) corners_.push_back(mesh.points[v]);
    const Vec3d normal =
        twiceAreaVector(corners_.size(), [&](std::size_t i) { return corners_[i]; });
    if (normal.isZero(0)) return;
    const std::size_t first = triangles_.size();
    triangulate(corners_, triangles_, fans_);
    for (std::size_t t = first; t < triangles_.size(); ++t)
      for (Index& corner : triangles_[t]) corner = face[corner];
    normals_.resize(triangles_.size(), normal.normalized());
  }

  void add(const openvdb::Coord& voxel, const Vec3d& normal) {
    const openvdb::Coord origin(voxel.x() & ~7, voxel.y() & ~7, voxel.z() & ~7);
    if (origin != origin_ || !known_) {
      origin_ = origin;
      place_ = sums_.placeOf(origin);
      known_ = true;
    }
    if (place_.leaf == nullptr) return;
    const unsigned offset = VoxelSums::Leaf::coordToOffset(voxel);
    if (place_.leaf->isValueOn(offset)) sums_.add(place_, offset, normal);
  }

  VoxelSums& sums_;
  openvdb::Coord origin_;
  VoxelSums::Place place_;  // of that leaf
  bool known_ = false;
  std::vector<Vec3d> corners_;                   // of a face
  std::vector<std::array<Index, 3>> triangles_;  // of a piece
  std::vector<Vec3d> normals_;                   // of these
  TriangulationReport fans_;
};

}  // namespace

void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelSums& sums) {
  tbb::enumerable_thread_specific<NormalSink> sinks([&] { return NormalSink(sums); });
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
