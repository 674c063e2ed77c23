#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// Which edges of a mesh are sharp.
struct CreaseRule {
  std::optional<double> degrees = {};  ///< edges whose faces turn by more than this, 0 to 180
  bool groups = false;                 ///< edges between smoothing groups

  bool operator==(const CreaseRule&) const = default;
};

/// Name of the rule on the command line: "40", "groups", "40,groups".
std::string creaseRuleName(const CreaseRule& rule);

/// Rule of the name; nothing if the name is not valid.
std::optional<CreaseRule> creaseRuleNamed(std::string_view name);

/// All valid names, as a message lists them.
inline constexpr const char* kAllCreaseRuleNames =
    "degrees from 0 to 180, groups, or both with a comma";

}  // namespace vox
