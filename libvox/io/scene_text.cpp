// Typed values of a scene file; messages give the place of an error.

#include "libvox/io/scene_text.h"

#include "libvox/io/read_mesh.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace vox {
namespace {

/// Refuses dotted keys with so many parts that the recursive parser would run out of stack.
void requireShallowKeys(const SceneText& text, std::string_view content) {
  constexpr int kMostDots = 1000;
  int dots = 0;
  toml::source_index line = 1;
  for (const char c : content) {
    const bool inKey = std::isalnum(static_cast<unsigned char>(c)) ||
                       std::string_view("_-.\"' \t").find(c) != std::string_view::npos;
    dots = !inKey ? 0 : dots + (c == '.');
    line += c == '\n';
    if (dots > kMostDots) text.fail({{line, 1}, {line, 1}, nullptr}, "a key nested too deeply");
  }
}

[[noreturn]] void failStopRule(const SceneText& text, const toml::node& node) {
  text.fail(node,
            "until must be \"voxel\" or { levels = K, diameter = D, angle = DEG, flatness = D }, "
            "some of them");
}

}  // namespace

SceneText::SceneText(const std::filesystem::path& name, std::string_view content) : file(name) {
  hash.addFile(content);
  requireShallowKeys(*this, content);
  try {
    root = toml::parse(content, file.string());
  } catch (const toml::parse_error& wrong) {
    fail(wrong.source(), std::string(wrong.description()));
  }
}

void requireKnownKeys(const SceneText& text, const toml::table& table, const std::string& where,
                      std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string names;
    for (const auto name : known) names += (names.empty() ? "" : ", ") + std::string(name);
    text.fail(key.source(),
              "unknown key " + quote(key.str()) + " in " + where + "; known are " + names);
  }
}

const toml::table& requireTable(const SceneText& text, const toml::node& node,
                                const std::string& name) {
  if (const auto* table = node.as_table()) return *table;
  text.fail(node, name + " must be a table");
}

const toml::array& requireArray(const SceneText& text, const toml::node& node,
                                const std::string& name) {
  if (const auto* array = node.as_array()) return *array;
  text.fail(node, name + " must be an array");
}

std::string requireString(const SceneText& text, const toml::node& node, const std::string& name) {
  const auto value = node.value_exact<std::string>();
  if (value && value->find('\0') != std::string::npos) text.fail(node, name + " holds a NUL");
  if (value) return *value;
  text.fail(node, name + " must be a string");
}

bool requireBoolean(const SceneText& text, const toml::node& node, const std::string& name) {
  if (const auto* flag = node.as_boolean()) return flag->get();
  text.fail(node, name + " must be true or false");
}

double requireNumber(const SceneText& text, const toml::node& node, const std::string& name) {
  if (node.is_number()) {
    const double number = *node.value<double>();
    if (!std::isfinite(number) || std::abs(number) > kMaxCoordinate)
      text.fail(node, name + " must be finite and at most 1e15 in size");
    return number;
  }
  text.fail(node, name + " must be a number");
}

std::int64_t requireInteger(const SceneText& text, const toml::node& node, const std::string& name,
                            std::int64_t low, std::int64_t high) {
  const auto number = node.value_exact<std::int64_t>();
  if (!number) text.fail(node, name + " must be an integer");
  if (*number < low || *number > high)
    text.fail(node, name + " must lie between " + std::to_string(low) + " and " +
                        std::to_string(high) + ", not " + std::to_string(*number));
  return *number;
}

Vec3d requireVector(const SceneText& text, const toml::node& node, const std::string& name) {
  const toml::array& array = requireArray(text, node, name);
  if (array.size() != 3) text.fail(node, name + " must have 3 numbers");
  return {requireNumber(text, array[0], name), requireNumber(text, array[1], name),
          requireNumber(text, array[2], name)};
}

StopRule requireStopRule(const SceneText& text, const toml::node& node) {
  const auto* table = node.as_table();
  StopRule rule;
  if (table == nullptr) {
    if (node.value_exact<std::string>() != stopRuleName(rule)) failStopRule(text, node);
    return rule;
  }
  requireKnownKeys(text, *table, "until", {"levels", "diameter", "angle", "flatness"});
  if (const auto* levels = table->get("levels"))
    rule.levels = static_cast<int>(requireInteger(text, *levels, "levels", 0, kMostLevels));
  const auto read = [&](const char* key, std::optional<double> StopRule::*limit) {
    const auto* value = table->get(key);
    if (value == nullptr) return;
    StopRule alone;
    rule.*limit = alone.*limit = requireNumber(text, *value, key);
    if (const std::string fault = faultOf(alone); !fault.empty()) text.fail(*value, fault);
  };
  read("diameter", &StopRule::diameter);
  read("angle", &StopRule::angle);
  read("flatness", &StopRule::flatness);
  if (rule.untilVoxel()) failStopRule(text, node);
  return rule;
}

ComponentLimit requireComponentLimit(const SceneText& text, const toml::node& node) {
  constexpr std::int64_t kMostFaces = kNone - 1;
  const toml::table& table = requireTable(text, node, "drop_components");
  requireKnownKeys(text, table, "drop_components", {"below", "size"});
  ComponentLimit limit;
  if (const auto* below = table.get("below"))
    limit.below = static_cast<Index>(requireInteger(text, *below, "below", 0, kMostFaces));
  if (const auto* size = table.get("size")) {
    limit.size = requireNumber(text, *size, "size");
    if (!(*limit.size >= 0)) text.fail(*size, "size must be 0 or more");
  }
  if (!limit.below && !limit.size) text.fail(node, "drop_components needs below or size");
  return limit;
}

}  // namespace vox
