// Options of volumes: ranges of numbers, and names of grids.

#include "libvox/options/volume_options.h"

#include "libvox/core/error.h"

#include <sstream>

namespace vox {
namespace {

void requireBetween(const std::optional<double>& value, double low, double high,
                    const std::string& name) {
  if (!value || (*value >= low && *value <= high)) return;
  std::ostringstream text;
  text << name << " must lie between " << low << " and " << high << ", not " << *value;
  throw UsageError(text.str());
}

}  // namespace

std::string gridNameFor(GridKind kind, Target target) {
  // Houdini's attributes: normals N, colours Cd.
  const std::string name = nameIn(kGridNames, kind);
  if (target != Target::kHoudini) return name;
  return name == "normal" ? "N" : name == "color" ? "Cd" : name;
}

void requireValid(const VolumeSettings& settings) {
  requireBetween(settings.gain, 1e-30, 1e30, "the gain");
  requireBetween(settings.band, 1, 1000, "the band");
  requireBetween(settings.tolerance, 1e-4, 10, "the tolerance");
}

}  // namespace vox
