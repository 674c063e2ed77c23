// Heights to cells.

#include "libvox/foot/height_maker.h"

#include "libvox/foot/triangle_prism.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {

void addHeightCell(const HeightPatch& patch, float reach, float newtonStop, std::uint32_t owner,
                   CellStore& store) {
  constexpr double kMargin = 0.05;  // voxels
  // The part of a unit normal along an axis.
  const auto leanOf = [](double slope) { return slope / std::sqrt(1 + slope * slope); };
  const double tube = double{reach} + kMargin;
  const double sag = 0.2 * (patch.high - patch.low) + kMargin;
  // Neighbours overlap a little. Where normals are off, so are the tubes; and tubes widen between
  // the places where slopes were measured.
  const double overlap = std::min(0.02, 0.05 * std::min(patch.half[0], patch.half[1]));
  const double widest = overlap + kMostSlopeError * tube;
  constexpr double kWider = 1.2;  // than at 3 x 3 places; a voxel that all miss is a hole
  const std::array<double, 3> half = {
      patch.half[0] + kWider * leanOf(patch.steepest[0]) * tube + widest,
      patch.half[1] + kWider * leanOf(patch.steepest[1]) * tube + widest,
      (patch.high - patch.low) / 2 + sag + tube};
  const openvdb::Coord origin = openvdb::Coord::round(openvdb::Vec3d(patch.middle.data()));
  const Vec3d middle = patch.middle - Vec3d(origin.x(), origin.y(), origin.z());
  const Vec3d centre = middle + (patch.low + patch.high) / 2 * patch.axes[2];
  Prism prism;
  prism.origin = origin;
  prism.centre = asFloats(centre);
  Vec3d box = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    prism.normals[k] = asFloats(patch.axes[k] / half[k]);
    box += half[k] * patch.axes[k].cwiseAbs();
  }
  for (int x = 0; x < 3; ++x) {
    prism.box.min()[x] = origin[x] + static_cast<int>(std::ceil(centre[x] - box[x]));
    prism.box.max()[x] = origin[x] + static_cast<int>(std::floor(centre[x] + box[x]));
  }
  if (prism.box.empty() || store.isFar(prism.box)) return;
  const auto added = store.heights.emplace_back();
  HeightCell& cell = *added;
  cell.prism = prism;
  cell.middle = asFloats(middle);
  for (std::size_t k = 0; k < 3; ++k) cell.axes[k] = asFloats(patch.axes[k]);
  double powerB = 1;
  for (std::size_t j = 0, m = 0; j < 5; ++j, powerB /= patch.half[1]) {
    double power = powerB;
    for (std::size_t i = 0; i + j < 5; ++i, ++m, power /= patch.half[0])
      cell.height[m] = static_cast<float>(power * patch.height[m]);
  }
  cell.sideCount = static_cast<std::uint32_t>(patch.sideCount);
  for (std::size_t k = 0; k < patch.sideCount; ++k) {
    const auto& [x, y, most] = patch.sides[k];
    cell.sides[k] = {static_cast<float>(x), static_cast<float>(y),
                     static_cast<float>(most + overlap)};
  }
  cell.half = {static_cast<float>(patch.half[0] + overlap),
               static_cast<float>(patch.half[1] + overlap)};
  cell.stop = std::min(newtonStop, 0.05F * std::max(cell.half[0], cell.half[1]));
  store.bin(prism, owner, added - store.heights.begin(), CellKind::kHeight);
}

}  // namespace vox
