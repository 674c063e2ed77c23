#pragma once

#include "libvox/mesh/patch.h"

#include <array>
#include <cstdint>

namespace vox {

/// A quadratic polynomial on 0 .. 1 as Bernstein coefficients: it stays in their convex hull.
using Quadratic = std::array<Vec3d, 3>;

/// What lies between two rows of a patch's N x N vertices, seen as filled from around.
///
/// The walk around such a strip goes along one row, a column, the other row and back. Say that each
/// of its vertices has a place s on some curve and differs from the curve there by no more than a
/// small box E holds, and that s changes by at most h from one to the next. Then the walk can be
/// filled with triangles whose corners differ by at most h in s: cut off the corner where s is
/// largest, again and again. None of their sides is longer than what the curve covers in h, plus
/// the size of E.
class PatchStrips {
 public:
  /// @param patch   complete, of finite points; must outlive this
  /// @param levels  N = 2^levels
  PatchStrips(const Patch& patch, int levels);

  /// Whether triangles no larger than kVertexConversionSpan fill the walk around the strip between
  /// two rows. Never true in error; two curves are tried.
  bool fillable(std::int64_t i, std::int64_t j) const;

 private:
  /// Between two rows, which lie at places from 0 to 1 across the patch, so many steps apart.
  struct Strip {
    Quadratic first, second;
    double from, to;
    double steps;
  };
  /// Upper bounds for the triangles (L-inf, in voxels), from a curve each.
  double longestSideAlongRow(const Strip& strip) const;
  double longestSideAlongCubic(const Strip& strip) const;
  Quadratic row(std::int64_t i) const;
  double placeAcross(std::int64_t i) const;

  const Patch& patch_;
  std::int64_t n_;
  Quadratic bendAcross_;              ///< second derivative from row to row
  std::array<Quadratic, 2> columns_;  ///< the outermost
};

}  // namespace vox
