// Which parts of a surface separate inside from outside.

#include "libvox/pipeline/exposed_pieces.h"

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/patch.h"
#include "libvox/mesh/patch_parts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace vox {
namespace {

constexpr double kLongest = 6;   // voxels, of a piece that is looked at as a whole
constexpr double kShortest = 1;  // voxels, of a piece that is cut

/// Longest differences of control points along u and along v.
std::array<double, 2> extentsOf(const LimitPiece& piece) {
  std::array<double, 2> extents = {0, 0};
  const auto& p = piece.points;
  for (std::size_t i = 0; i < 3; ++i) {
    extents[0] = std::max(extents[0], (p[2][i] - p[0][i]).cwiseAbs().maxCoeff());
    extents[1] = std::max(extents[1], (p[i][2] - p[i][0]).cwiseAbs().maxCoeff());
  }
  return extents;
}

LimitPiece halfOf(const LimitPiece& piece, bool alongU, bool high) {
  Patch patch{piece.points};
  if (!alongU) patch = quarterTurn(patch);
  patch = halvesAlongU(patch)[high == alongU ? 1 : 0];  // turned, u runs against the old v
  if (!alongU)
    for (int turns = 0; turns < 3; ++turns) patch = quarterTurn(patch);
  const unsigned inner = alongU ? (high ? kSideU0 : kSideU1) : (high ? kSideV0 : kSideV1);
  return {patch.points, static_cast<std::uint8_t>(piece.boundarySides & ~inner),
          alongU ? piece.square.halfAlongU(high) : piece.square.halfAlongV(high)};
}

/// Whether a voxel that is not solid lies near a point of a surface, on either side.
bool isExposed(const Vec3d& point, const Vec3d& normal, const openvdb::MaskTree& solid,
               double depth) {
  const auto isOutside = [&](double offset) {
    const Vec3d at = point + offset * normal;
    return !solid.isValueOn(openvdb::Coord::round(openvdb::Vec3d(at.data())));
  };
  constexpr double kBeyondSurface = 1.1;  // beyond the voxels that the surface itself crosses
  constexpr double kStep = 0.55;
  for (double offset = kBeyondSurface; offset <= depth; offset += kStep)
    if (isOutside(offset) || isOutside(-offset)) return true;
  return false;
}

/// Collects the exposed parts of triangles.
class TriangleCutter {
 public:
  TriangleCutter(const openvdb::MaskTree& solid, double depth) : solid_(solid), depth_(depth) {}

  using Triangle = std::array<Vec3d, 3>;

  /// Adds the exposed parts; those of a triangle that is exposed as a whole as one.
  /// @return whether it is
  bool add(const Triangle& triangle) {
    std::size_t longest = 0;
    double length = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (triangle[(i + 1) % 3] - triangle[i]).norm();
      if (side <= length) continue;
      length = side;
      longest = i;
    }
    if (length <= kLongest) {
      const int exposed = exposedPlaces(triangle, length <= kShortest);
      if (exposed == 0) return false;
      if (exposed == kAllPlaces) {
        parts_.push_back(triangle);
        return true;
      }
    }
    const Vec3d& a = triangle[longest];
    const Vec3d& b = triangle[(longest + 1) % 3];
    const Vec3d& c = triangle[(longest + 2) % 3];
    const Vec3d middle = (a + b) / 2;
    const std::size_t before = parts_.size();
    const bool first = add({a, middle, c});
    const bool second = add({middle, b, c});
    if (!first || !second) return false;
    parts_.resize(before);
    parts_.push_back(triangle);
    return true;
  }

  PolygonMesh mesh() const {
    PolygonMesh mesh;
    for (const Triangle& part : parts_) {
      const Index first = mesh.pointCount();
      mesh.points.insert(mesh.points.end(), part.begin(), part.end());
      mesh.addFace(std::array<Index, 3>{first, first + 1, first + 2});
    }
    return mesh;
  }

 private:
  static constexpr int kAllPlaces = 7;

  /// At how many of some places a triangle is exposed; none or all if only its middle counts.
  int exposedPlaces(const Triangle& t, bool onlyMiddle) const {
    const Vec3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Vec3d middle = (t[0] + t[1] + t[2]) / 3;
    const auto isExposedAt = [&](const Vec3d& point) {
      return isExposed(point, normal, solid_, depth_);
    };
    if (onlyMiddle) return isExposedAt(middle) ? kAllPlaces : 0;
    int exposed = isExposedAt(middle) ? 1 : 0;
    constexpr double kInward = 0.04;  // of the way to the middle
    for (std::size_t i = 0; i < 3; ++i)
      for (const Vec3d& edge : {t[i], Vec3d((t[i] + t[(i + 1) % 3]) / 2)})
        exposed += isExposedAt(edge + kInward * (middle - edge)) ? 1 : 0;
    return exposed;
  }

  const openvdb::MaskTree& solid_;
  double depth_;
  std::vector<Triangle> parts_;
};

}  // namespace

bool ExposedPieces::isExposedAt(const LimitPiece& piece, double u, double v) const {
  const SplinePoint place = splinePoint(piece.points, {u}, {v});
  return place.normal.isZero(0) || isExposed(place.point, place.normal, solid_, depth_);
}

void ExposedPieces::piece(const LimitPiece& piece) {
  const auto [extentU, extentV] = extentsOf(piece);
  const double extent = std::max(extentU, extentV);
  const auto cut = [&] {
    for (const bool high : {false, true}) this->piece(halfOf(piece, extentU >= extentV, high));
  };
  if (extent > kLongest) return cut();
  if (extent <= kShortest) {
    if (isExposedAt(piece, 0.5, 0.5)) next_.piece(piece);
    return;
  }
  constexpr std::array<double, 3> kPlaces = {0.02, 0.5, 0.98};
  int exposed = 0;
  for (const double u : kPlaces)
    for (const double v : kPlaces) exposed += isExposedAt(piece, u, v) ? 1 : 0;
  if (exposed == 9) return next_.piece(piece);
  if (exposed > 0) cut();
}

PolygonMesh exposedTriangles(const PolygonMesh& triangles, const openvdb::MaskTree& solid,
                             double depth) {
  TriangleCutter cutter(solid, depth);
  for (Index f = 0; f < triangles.faceCount(); ++f) {
    const auto face = triangles.face(f);
    cutter.add({triangles.points[face[0]], triangles.points[face[1]], triangles.points[face[2]]});
  }
  return cutter.mesh();
}

}  // namespace vox
