// Options of volumes.

#include "libvox/grid/volume_options.h"

#include "libvox/core/error.h"

#include <sstream>

namespace vox {

VolumeOptions overriding(const VolumeOptions& first, const VolumeOptions& second) {
  VolumeOptions all = first;
  if (!all.fill) all.fill = second.fill;
  if (!all.gain) all.gain = second.gain;
  if (!all.openMesh) all.openMesh = second.openMesh;
  return all;
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
