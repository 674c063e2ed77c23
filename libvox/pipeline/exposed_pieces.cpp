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

}  // namespace

/// Whether a voxel that is not solid lies near a point, on either side.
bool ExposedPieces::isExposed(const LimitPiece& piece, double u, double v) const {
  const SplinePoint place = splinePoint(piece.points, {u}, {v});
  if (place.normal.isZero(0)) return true;
  const auto isOutside = [&](double offset) {
    const Vec3d at = place.point + offset * place.normal;
    return !solid_.isValueOn(openvdb::Coord::round(openvdb::Vec3d(at.data())));
  };
  constexpr double kBeyondSurface = 1.1;  // beyond the voxels that the surface itself crosses
  constexpr double kStep = 0.55;
  for (double offset = kBeyondSurface; offset <= depth_; offset += kStep)
    if (isOutside(offset) || isOutside(-offset)) return true;
  return false;
}

void ExposedPieces::piece(const LimitPiece& piece) {
  const auto [extentU, extentV] = extentsOf(piece);
  const double extent = std::max(extentU, extentV);
  const auto cut = [&] {
    for (const bool high : {false, true}) this->piece(halfOf(piece, extentU >= extentV, high));
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
