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
#include <cmath>
#include <span>
#include <vector>

namespace vox {
namespace {

/// A triangle whose normal is a blend of those of its corners.
class BlendedTriangle {
 public:
  BlendedTriangle() = default;
  /// @param flat  the normal where the corners have none to speak of
  BlendedTriangle(const std::array<Vec3d, 3>& corners, std::array<Vec3d, 3> normals,
                  const Vec3d& flat)
      : a_(corners[0]),
        ab_(corners[1] - corners[0]),
        ac_(corners[2] - corners[0]),
        flat_(flat),
        abAb_(ab_.squaredNorm()),
        abAc_(ab_.dot(ac_)),
        acAc_(ac_.squaredNorm()) {
    for (Vec3d& normal : normals)
      if (normal.isZero(0)) normal = flat;
    normal_ = normals[0];
    toB_ = normals[1] - normals[0];
    toC_ = normals[2] - normals[0];
  }

  /// Unit normal at the point nearest to p.
  Vec3d normalNear(const Vec3d& p) const {
    const auto [b, c] = nearest(p);
    const Vec3d normal = normal_ + b * toB_ + c * toC_;
    const double square = normal.squaredNorm();
    constexpr double kLeast = 1e-6;  // of normals that point away from each other
    return square > kLeast * kLeast ? Vec3d(normal / std::sqrt(square)) : flat_;
  }

 private:
  struct Weights {
    double b, c;
  };

  /// Weights of two corners in the nearest point. Source: Ericson 2005, "Real-Time Collision
  /// Detection", section 5.1.5; sides without length are never the nearest.
  Weights nearest(const Vec3d& p) const {
    const double ab = ab_.dot(p - a_);
    const double ac = ac_.dot(p - a_);
    if (ab <= 0 && ac <= 0) return {0, 0};
    const double abFromB = ab - abAb_;
    const double acFromB = ac - abAc_;
    if (abFromB >= 0 && acFromB <= abFromB) return {1, 0};
    const double abFromC = ab - abAc_;
    const double acFromC = ac - acAc_;
    if (acFromC >= 0 && abFromC <= acFromC) return {0, 1};
    const double inC = ab * acFromB - abFromB * ac;
    if (inC <= 0 && ab >= 0 && abFromB <= 0 && abAb_ > 0) return {ab / abAb_, 0};
    const double inB = abFromC * ac - ab * acFromC;
    if (inB <= 0 && ac >= 0 && acFromC <= 0 && acAc_ > 0) return {0, ac / acAc_};
    const double inA = abFromB * acFromC - abFromC * acFromB;
    const double fromB = acFromB - abFromB;
    const double fromC = abFromC - acFromC;
    if (inA <= 0 && fromB >= 0 && fromC >= 0 && fromB + fromC > 0)
      return {fromC / (fromB + fromC), fromB / (fromB + fromC)};
    const double sum = inA + inB + inC;
    if (!(sum > 0)) return {1.0 / 3, 1.0 / 3};
    return {inB / sum, inC / sum};
  }

  Vec3d a_, ab_, ac_;
  Vec3d normal_, toB_, toC_, flat_;
  double abAb_ = 0, abAc_ = 0, acAc_ = 0;
};

/// One thread's way from polygons to means.
class NormalSink : public PolygonSink {
 public:
  /// @param smooth  whether polygons bend with the surface that they stand for
  NormalSink(VoxelMeans& means, bool smooth) : writer_(means), smooth_(smooth) {}

  bool wantsNormals() const override { return smooth_; }

  void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) override {
    if (!smooth_) return faces(piece, 0, piece.faceCount());
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
