// What the parser knows of options, as text.

#include "apps/vox/option_help.h"

#include <CLI/CLI.hpp>

#include <string_view>

namespace vox::app {
namespace {

/// Start of the range in a type name: CLI11 appends it, as in "N:INT in [1 - 16]".
constexpr std::string_view kRange = "INT in [";

}  // namespace

std::string valueName(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  return type.find(kRange) == std::string::npos ? type : type.substr(0, type.find(':'));
}

std::string description(const CLI::Option& option) {
  std::string text = option.get_description();
  const std::string type = option.get_type_name();
  if (const std::size_t range = type.find(kRange); range != std::string::npos) {
    const std::size_t begin = range + kRange.size();
    text += " (from " + type.substr(begin, type.find(']', begin) - begin) + ")";
    text.replace(text.rfind(" - "), 3, " to ");
  }
  if (const std::string value = option.get_default_str(); !value.empty())
    text += " (default: " + value + ")";
  if (option.get_required() && option.nonpositional()) text += " (required)";
  return text;
}

}  // namespace vox::app
