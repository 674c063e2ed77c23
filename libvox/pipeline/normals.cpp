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
#include <span>
#include <vector>

namespace vox {
namespace {

/// Where on a triangle the point nearest to p is: weights of the corners.
/// Source: Ericson 2005, "Real-Time Collision Detection", section 5.1.5.
std::array<double, 3> nearestOn(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double inC = d1 * d4 - d3 * d2;
  if (inC <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double inB = d5 * d2 - d1 * d6;
  if (inB <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double inA = d3 * d6 - d5 * d4;
  const double fromB = d4 - d3;
  const double fromC = d5 - d6;
  if (inA <= 0 && fromB >= 0 && fromC >= 0)
    return {0, fromC / (fromB + fromC), fromB / (fromB + fromC)};
  const double sum = inA + inB + inC;
  return {inA / sum, inB / sum, inC / sum};
}

/// One thread's way from polygons to means.
class NormalSink : public PolygonSink {
 public:
  /// @param smooth  whether polygons bend with the surface that they stand for
  NormalSink(VoxelMeans& means, bool smooth) : writer_(means), smooth_(smooth) {}

  bool wantsNormals() const override { return smooth_; }

  void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) override {
    if (!smooth_) return faces(piece, 0, piece.faceCount());
    triangulate(piece, 0, piece.faceCount());
    scanTriangles(piece.points, triangles_, Separation::k26, [&](const VoxelBlock& block) {
      const auto& corners = triangles_[block.triangle];
      const Vec3d& flat = normals_[block.triangle];
      const Vec3d &a = piece.points[corners[0]], &b = piece.points[corners[1]],
                  &c = piece.points[corners[2]];
      const auto normalAt = [&](std::size_t i) -> const Vec3d& {
        const Vec3d& normal = normals[corners[i]];
        return normal.isZero(0) ? flat : normal;
      };
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        const auto weights = nearestOn(a, b, c, Vec3d(x, y, z));
        const Vec3d normal =
            weights[0] * normalAt(0) + weights[1] * normalAt(1) + weights[2] * normalAt(2);
        // Not so where the corners' point away from each other.
        const bool sound = normal.squaredNorm() > kLeastBlend * kLeastBlend;
        writer_.add({x, y, z}, sound ? normal.normalized() : flat);
      });
    });
  }

  /// Faces that are flat.
  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangulate(mesh, begin, end);
    scanTriangles(mesh.points, triangles_, Separation::k26, [this](const VoxelBlock& block) {
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        writer_.add({x, y, z}, normals_[block.triangle]);
      });
    });
  }

 private:
  static constexpr double kLeastBlend = 1e-6;

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
  bool smooth_;
  FaceTriangulator faces_;
  std::vector<std::array<Index, 3>> triangles_;  // of a piece
  std::vector<Vec3d> normals_;                   // of their polygons
};

}  // namespace

void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means) {
  tbb::enumerable_thread_specific<NormalSink> sinks(
      [&] { return NormalSink(means, way.polygons && way.until.levels != 0); });
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
