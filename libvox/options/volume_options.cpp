// Options of volumes: ranges of numbers, and names of grids.

#include "libvox/options/volume_options.h"

#include "libvox/core/error.h"

#include <charconv>
#include <sstream>
#include <system_error>

namespace vox {
namespace {

void requireBetween(const std::optional<double>& value, double low, double high,
                    const std::string& name) {
  if (!value || (*value >= low && *value <= high)) return;
  std::ostringstream text;
  text << name << " must lie between " << low << " and " << high << ", not " << *value;
  throw UsageError(text.str());
}

std::optional<double> numberOfText(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<BandWidths> bandWidthsIn(std::string_view text) {
  const std::size_t comma = text.find(',');
  const auto in = numberOfText(text.substr(0, comma));
  const auto out = comma == text.npos ? in : numberOfText(text.substr(comma + 1));
  if (!in || !out) return std::nullopt;
  return BandWidths(*in, *out);
}

std::string gridNameFor(GridKind kind, Target target) {
  // Houdini's attributes: normals N, colours Cd.
  const std::string name = nameIn(kGridNames, kind);
  if (target != Target::kHoudini) return name;
  return name == "normal" ? "N" : name == "color" ? "Cd" : name;
}

void requireValid(const VolumeSettings& settings) {
  requireBetween(settings.gain, 1e-30, 1e30, "the gain");
  for (const double width : {settings.band.in, settings.band.out})
    requireBetween(width, 1, 1000, "the band");
  requireBetween(settings.close, 0, kWidestClosing, "close");
  requireBetween(settings.tolerance, 1e-4, 10, "the tolerance");
}

}  // namespace vox
