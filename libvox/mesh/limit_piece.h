#pragma once

#include "libvox/core/types.h"

#include <array>
#include <cstdint>

namespace vox {

/// A rectangle in the unit square of a corner. The part of the limit surface that belongs to
/// corner i of face f is a map of the unit square (u, v): (1, 1) is the limit point of f (its
/// centroid), (0, 0) that of the vertex, (1, 0) and (0, 1) those of the edges from corner i to the
/// next and from the previous corner to corner i. A piece with parameters (u', v') covers
/// (u + sideU u', v + sideV v') of it.
struct CornerSquare {
  Index corner = kNone;  ///< of the base mesh
  double u = 0, v = 0;
  double sideU = 1, sideV = 1;  ///< negative: turned by 180 degrees

  /// The half with the parameters u' >= 1/2 if `high`, else u' <= 1/2.
  CornerSquare halfAlongU(bool high) const {
    return {corner, high ? u + sideU / 2 : u, v, sideU / 2, sideV};
  }
  CornerSquare halfAlongV(bool high) const {
    return {corner, u, high ? v + sideV / 2 : v, sideU, sideV / 2};
  }
  CornerSquare quarter(bool highU, bool highV) const { return halfAlongU(highU).halfAlongV(highV); }
  /// The same rectangle with both parameters running the other way.
  CornerSquare turned() const { return {corner, u + sideU, v + sideV, -sideU, -sideV}; }
};

/// Sides of a piece that lie on the boundary of the surface.
enum BoundarySide : std::uint8_t { kSideU0 = 1, kSideU1 = 2, kSideV0 = 4, kSideV1 = 8 };
inline constexpr std::uint8_t kAllSides = 15;  ///< of a piece that is a curve of a free boundary

/// A piece of the limit surface: a biquadratic B-spline with 3 x 3 control points, over the
/// parameters 0 .. 1. u, v and the outward normal are right-handed.
struct LimitPiece {
  std::array<std::array<Vec3d, 3>, 3> points;  ///< [u][v], index space
  std::uint8_t boundarySides = 0;              ///< a set of BoundarySide
  CornerSquare square = {};
};

/// Largest distances, along the normal, between the limit surface and pieces that treat a face as a
/// quad, in voxels.
struct PieceTolerance {
  double small;  ///< where the pieces of level 1 have sides of at most kSmallPiece
  double large;  ///< elsewhere
};
inline constexpr double kSmallPiece = 2.5;  // voxels

/// Receives the pieces of a limit surface.
class LimitSink {
 public:
  virtual ~LimitSink() = default;
  virtual void piece(const LimitPiece& piece) = 0;
};

}  // namespace vox
