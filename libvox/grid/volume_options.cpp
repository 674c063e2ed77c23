// Options of volumes.

#include "libvox/grid/volume_options.h"

#include "libvox/core/error.h"

#include <sstream>

namespace vox {

VolumeOptions overriding(const VolumeOptions& first, const VolumeOptions& second) {
  VolumeOptions all = first;
  const auto fillIn = [&](auto VolumeOptions::*option) {
    if (!(all.*option)) all.*option = second.*option;
  };
  fillIn(&VolumeOptions::fill);
  fillIn(&VolumeOptions::gain);
  fillIn(&VolumeOptions::openMesh);
  fillIn(&VolumeOptions::half);
  fillIn(&VolumeOptions::compression);
  fillIn(&VolumeOptions::target);
  fillIn(&VolumeOptions::up);
  return all;
}

std::string gridNameFor(GridKind kind, const VolumeOptions& options) {
  // Houdini's attributes: normals N, colours Cd.
  const std::string name = gridName(kind);
  if (options.target != Target::kHoudini) return name;
  return name == "normal" ? "N" : name == "color" ? "Cd" : name;
}

Turn turnOf(const VolumeOptions& options) {
  const UpAxis targetUp = options.target == Target::kHoudini ? UpAxis::kY : UpAxis::kZ;
  if (options.up.value_or(targetUp) == targetUp) return Turn::kNoTurn;
  return targetUp == UpAxis::kZ ? Turn::kYToZ : Turn::kZToY;
}

void requireValid(const VolumeOptions& options) {
  constexpr double kSmallest = 1e-30;
  constexpr double kLargest = 1e30;
  if (!options.gain || (*options.gain >= kSmallest && *options.gain <= kLargest)) return;
  std::ostringstream text;
  text << "the gain must be positive and at most 1e30, not " << *options.gain;
  throw UsageError(text.str());
}

}  // namespace vox
