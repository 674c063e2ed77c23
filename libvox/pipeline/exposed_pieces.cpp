// Which parts of a surface separate inside from outside.

#include "libvox/pipeline/exposed_pieces.h"

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/patch.h"
#include "libvox/mesh/patch_parts.h"

#include <algorithm>

namespace vox {
namespace {

constexpr double kLongest = 6;   // voxels, of a piece that is looked at as a whole
constexpr double kShortest = 1;  // voxels, of a piece that is cut

/// Longest side of the box of the control points.
double extentOf(const LimitPiece& piece) {
  Vec3d low = piece.points[0][0];
  Vec3d high = low;
  for (const auto& row : piece.points)
    for (const Vec3d& p : row) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  return (high - low).maxCoeff();
}

/// The quarters of a piece.
std::array<LimitPiece, 4> quartersOf(const LimitPiece& piece) {
  const auto children = childrenOf(Patch{piece.points});
  std::array<LimitPiece, 4> quarters;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool highU = i >= 2;
    const bool highV = i % 2 == 1;
    const unsigned inner = (highU ? kSideU0 : kSideU1) | (highV ? kSideV0 : kSideV1);
    quarters[i] = {children[highU ? 1 : 0][highV ? 1 : 0].points,
                   static_cast<std::uint8_t>(piece.boundarySides & ~inner),
                   piece.square.quarter(highU, highV)};
  }
  return quarters;
}

}  // namespace

/// Whether a voxel that is not solid lies near a point, on either side.
bool ExposedPieces::isExposed(const LimitPiece& piece, double u, double v) const {
  const SplinePlace atU{u}, atV{v};
  std::array<Vec3d, 3> values, slopes;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& p = piece.points;
    values[j] = atU.value(p[0][j], p[1][j], p[2][j]);
    slopes[j] = atU.slope(p[0][j], p[1][j], p[2][j]);
  }
  const Vec3d point = atV.value(values[0], values[1], values[2]);
  const Vec3d normal = normalOfTangents(atV.value(slopes[0], slopes[1], slopes[2]),
                                        atV.slope(values[0], values[1], values[2]));
  if (normal.isZero(0)) return true;
  const auto isOutside = [&](double offset) {
    const Vec3d at = point + offset * normal;
    return !solid_.isValueOn(openvdb::Coord::round(openvdb::Vec3d(at.data())));
  };
  constexpr double kBeyondSurface = 1.1;  // beyond the voxels that the surface itself crosses
  constexpr double kStep = 0.55;
  for (double offset = kBeyondSurface; offset <= depth_; offset += kStep)
    if (isOutside(offset) || isOutside(-offset)) return true;
  return false;
}

void ExposedPieces::piece(const LimitPiece& piece) {
  const double extent = extentOf(piece);
  const auto cut = [&] {
    for (const LimitPiece& quarter : quartersOf(piece)) this->piece(quarter);
  };
  if (extent > kLongest) return cut();
  if (extent <= kShortest) {
    if (isExposed(piece, 0.5, 0.5)) next_.piece(piece);
    return;
  }
  constexpr std::array<double, 3> kPlaces = {0.02, 0.5, 0.98};
  int exposed = 0;
  for (const double u : kPlaces)
    for (const double v : kPlaces) exposed += isExposed(piece, u, v) ? 1 : 0;
  if (exposed == 9) return next_.piece(piece);
  if (exposed > 0) cut();
}

}  // namespace vox
