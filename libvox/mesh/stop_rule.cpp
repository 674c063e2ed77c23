// Names of the stop rules.

#include "libvox/mesh/stop_rule.h"

#include <charconv>
#include <system_error>

namespace vox {
namespace {

constexpr std::string_view kVoxel = "voxel";
constexpr std::string_view kLevels = "levels=";

}  // namespace

std::string stopRuleName(const StopRule& rule) {
  if (!rule.levels) return std::string(kVoxel);
  return std::string(kLevels) + std::to_string(*rule.levels);
}

std::optional<StopRule> stopRuleNamed(std::string_view name) {
  if (name == kVoxel) return StopRule();
  if (!name.starts_with(kLevels)) return std::nullopt;
  const std::string_view number = name.substr(kLevels.size());
  int levels = -1;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), levels);
  const bool whole = error == std::errc() && end == number.data() + number.size();
  if (!whole || levels < 0 || levels > kMostLevels) return std::nullopt;
  return StopRule{levels};
}

std::string allStopRuleNames() {
  return std::string(kVoxel) + ", " + std::string(kLevels) + "K with K from 0 to " +
         std::to_string(kMostLevels);
}

}  // namespace vox
