// Names of the stop rules.

#include "libvox/options/stop_rule.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace vox {
namespace {

constexpr std::string_view kVoxel = "voxel";

template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

template <class Number>
void takeLeast(std::optional<Number>& limit, Number value) {
  limit = limit ? std::min(*limit, value) : value;
}

/// Adds one part of a rule's name, such as "angle=5", to the rule.
/// @return false if the part is not valid
bool addPart(std::string_view part, StopRule& rule) {
  const auto equals = part.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string_view kind = part.substr(0, equals);
  const std::string_view value = part.substr(equals + 1);
  if (kind == "levels") {
    const auto levels = parse<int>(value);
    if (levels) takeLeast(rule.levels, *levels);
    return levels.has_value();
  }
  const auto number = parse<double>(value);
  if (!number) return false;
  StopRule alone;
  if (kind == "diameter") takeLeast(alone.diameter, *number);
  if (kind == "angle") takeLeast(alone.angle, *number);
  if (kind == "flatness") takeLeast(alone.flatness, *number);
  if (alone.untilVoxel() || !faultOf(alone).empty()) return false;
  // Of two limits of a kind, the larger one is met first.
  const auto take = [](std::optional<double>& limit, const std::optional<double>& value2) {
    if (value2) limit = std::max(limit.value_or(0), *value2);
  };
  take(rule.diameter, alone.diameter);
  take(rule.angle, alone.angle);
  take(rule.flatness, alone.flatness);
  return true;
}

}  // namespace

std::string faultOf(const StopRule& rule) {
  const auto positive = [](const std::optional<double>& value) {
    return !value || (*value > 0 && std::isfinite(*value));
  };
  if (rule.levels && (*rule.levels < 0 || *rule.levels > kMostLevels))
    return "levels must lie between 0 and " + std::to_string(kMostLevels) + ", not " +
           std::to_string(*rule.levels);
  if (!positive(rule.diameter)) return "diameter must be a positive number of voxels";
  if (!positive(rule.angle) || rule.angle.value_or(1) > 180)
    return "angle must be more than 0 and at most 180 degrees";
  if (!positive(rule.flatness)) return "flatness must be a positive number of voxels";
  return {};
}

std::string stopRuleName(const StopRule& rule) {
  std::ostringstream name;
  const auto add = [&](const char* kind, const auto& value) {
    if (value) name << (name.tellp() > 0 ? "," : "") << kind << '=' << *value;
  };
  add("levels", rule.levels);
  add("diameter", rule.diameter);
  add("angle", rule.angle);
  add("flatness", rule.flatness);
  return rule.untilVoxel() ? std::string(kVoxel) : name.str();
}

std::optional<StopRule> stopRuleNamed(std::string_view name) {
  if (name == kVoxel) return StopRule();
  StopRule rule;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find(',', begin), name.size());
    const std::string_view part = name.substr(begin, end - begin);
    if (part == kVoxel ? !addPart("diameter=1", rule) : !addPart(part, rule)) return std::nullopt;
    begin = end + 1;
  }
  if (!faultOf(rule).empty()) return std::nullopt;
  return rule;
}

std::string allStopRuleNames() {
  return std::string(kVoxel) + ", levels=K with K from 0 to " + std::to_string(kMostLevels) +
         ", diameter=D, angle=DEG, flatness=D, or several of them with commas";
}

}  // namespace vox
