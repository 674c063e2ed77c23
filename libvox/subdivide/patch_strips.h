#pragma once

#include "libvox/mesh/patch.h"

#include <array>
#include <cstdint>

namespace vox {

/// A quadratic polynomial on 0 .. 1, as Bernstein coefficients. Its values lie in their convex
/// hull.
using Quadratic = std::array<Vec3d, 3>;

/// The strips between rows of the N x N vertices of a patch. Decides whether small triangles can
/// fill a strip, using only the vertices on the walk around it: along one row, a column, the other
/// row and the other column.
///
/// Suppose that each vertex of the walk has a parameter s on some curve, that its difference from
/// the point of the curve at s lies in a small box E, and that s changes by at most h from one
/// vertex to the next. Then triangles whose corners differ by at most h in s can fill the walk: cut
/// off the corner with the largest s, again and again. No side of a triangle is longer than the
/// largest piece of the curve with length h in s, plus the size of E.
class PatchStrips {
 public:
  /// @param patch   with all four faces and finite points; must outlive this object
  /// @param levels  N = 2^levels
  PatchStrips(const Patch& patch, int levels);

  /// Whether triangles of size at most kVertexConversionSpan can fill the walk around the strip
  /// between rows i < j. Tries two curves. The answer may be false by mistake, but never true.
  bool fillable(std::int64_t i, std::int64_t j) const;

 private:
  struct Strip {
    Quadratic first, second;  ///< the two rows
    double from, to;          ///< their parameters across the patch, 0 to 1
    double steps;             ///< number of steps between them
  };
  /// Upper bounds of the sides of the triangles (L-inf, in voxels), each with another curve.
  double longestSideAlongRow(const Strip& strip) const;
  double longestSideAlongCubic(const Strip& strip) const;
  Quadratic row(std::int64_t i) const;
  double placeAcross(std::int64_t i) const;

  const Patch& patch_;
  std::int64_t n_;
  Quadratic bendAcross_;              ///< second derivative from row to row
  std::array<Quadratic, 2> columns_;  ///< the first and the last column
};

}  // namespace vox
