#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <memory>

/// Closest points of surfaces, exact and slow, with which tests compare level sets.
namespace vox::test {

/// A surface that knows its closest points. Thread-safe.
class Surface {
 public:
  struct Foot {
    double distance;        ///< at least 0
    double signedDistance;  ///< negative on the inner side of the surface at `point`
    Vec3d point;            ///< the point of the surface closest to the given one
    Vec3d normal;           ///< outward unit normal there; 0 if there is none
    double cosine;          ///< 1, or less where `point` is on a boundary: then the cosine of the
                            ///< angle between the normal and the way to the given point
  };
  struct Sample {
    Vec3d point;
    Vec3d normal;
  };

  virtual ~Surface() = default;
  virtual Foot of(const Vec3d& p) const = 0;
  /// A random point of the surface, the same for the same number; about evenly spread.
  virtual Sample sample(std::uint64_t number) const = 0;
};

/// The limit surface of a mesh, in the unit of its points.
///
/// Closest points are global minima: of each patch, the square of the distance is a polynomial. Its
/// Bernstein coefficients bound it from below, and bound its second derivatives. Squares of the
/// parameters that may hold a smaller value are halved until the polynomial is convex; there,
/// Newton's method finds the minimum. Distances are exact to about 1e-11; around extraordinary
/// faces, triangles of the size 2^-levels of a face stand for the surface (tests/limit_pieces.h).
class ClosestPoint : public Surface {
 public:
  using Foot = Surface::Foot;
  explicit ClosestPoint(const SubdivisionLevel& base, int levels);
  ~ClosestPoint() override;
  Foot of(const Vec3d& p) const override;
  Sample sample(std::uint64_t number) const override;

 private:
  class Pieces;
  std::unique_ptr<const Pieces> pieces_;
};

/// The polygons of a mesh, cut into triangles by FaceTriangulator. The side at edges and vertices
/// is that of their angle-weighted normals.
/// Source: Baerentzen & Aanaes, Signed distance computation using the angle weighted pseudonormal,
/// 2005.
class ClosestPolygon : public Surface {
 public:
  explicit ClosestPolygon(const PolygonMesh& mesh);
  ~ClosestPolygon() override;
  Foot of(const Vec3d& p) const override;
  Sample sample(std::uint64_t number) const override;

 private:
  class Triangles;
  std::unique_ptr<const Triangles> triangles_;
};

/// Hash of a number, with all bits mixed. Source: Vigna's SplitMix64, 2015.
inline std::uint64_t mixed(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15ULL;
  number = (number ^ (number >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  number = (number ^ (number >> 27U)) * 0x94d049bb133111ebULL;
  return number ^ (number >> 31U);
}

/// The hash of a number as a fraction in [0, 1).
inline double mixedFraction(std::uint64_t number) {
  return static_cast<double>(mixed(number) >> 11U) * 0x1p-53;
}

}  // namespace vox::test
