// Options of volumes: combination, checks, and what follows from the target program.

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

VolumeOptions overriding(const VolumeOptions& first, const VolumeOptions& second) {
  VolumeOptions all = first;
  const auto fillIn = [&](auto VolumeOptions::*option) {
    if (!(all.*option)) all.*option = second.*option;
  };
  fillIn(&VolumeOptions::fill);
  fillIn(&VolumeOptions::gain);
  fillIn(&VolumeOptions::openMesh);
  fillIn(&VolumeOptions::band);
  fillIn(&VolumeOptions::tolerance);
  fillIn(&VolumeOptions::half);
  fillIn(&VolumeOptions::compression);
  fillIn(&VolumeOptions::target);
  fillIn(&VolumeOptions::up);
  return all;
}

std::string gridNameFor(GridKind kind, const VolumeOptions& options) {
  // Houdini calls normals N and colours Cd.
  const std::string name = nameIn(kGridNames, kind);
  if (options.target != Target::kHoudini) return name;
  return name == "normal" ? "N" : name == "color" ? "Cd" : name;
}

void requireValid(const VolumeOptions& options) {
  requireBetween(options.gain, 1e-30, 1e30, "the gain");
  requireBetween(options.band, 1, 1000, "the band");
  requireBetween(options.tolerance, 1e-4, 10, "the tolerance");
}

}  // namespace vox
