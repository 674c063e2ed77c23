// Names of the rules for sharp edges.

#include "libvox/options/crease_rule.h"

#include <charconv>
#include <sstream>
#include <system_error>

namespace vox {
namespace {

constexpr std::string_view kGroups = "groups";
constexpr double kMostDegrees = 180;

bool addCreasePart(std::string_view part, CreaseRule& rule) {
  if (part == kGroups) {
    rule.groups = true;
    return true;
  }
  double degrees = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), degrees);
  if (error != std::errc() || end != part.data() + part.size()) return false;
  if (!(degrees >= 0 && degrees <= kMostDegrees) || rule.degrees) return false;
  rule.degrees = degrees;
  return true;
}

}  // namespace

std::string creaseRuleName(const CreaseRule& rule) {
  std::ostringstream name;
  name.precision(17);
  if (rule.degrees) name << *rule.degrees;
  if (rule.groups) name << (rule.degrees ? "," : "") << kGroups;
  return name.str();
}

std::optional<CreaseRule> creaseRuleNamed(std::string_view name) {
  CreaseRule rule;
  const std::size_t comma = name.find(',');
  if (!addCreasePart(name.substr(0, comma), rule)) return std::nullopt;
  if (comma != std::string_view::npos && !addCreasePart(name.substr(comma + 1), rule))
    return std::nullopt;
  return rule;
}

}  // namespace vox
