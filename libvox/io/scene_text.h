#pragma once

#include "libvox/core/error.h"
#include "libvox/core/hash.h"
#include "libvox/core/names.h"
#include "libvox/core/types.h"
#include "libvox/io/text_scanner.h"
#include "libvox/options/component_limit.h"
#include "libvox/options/stop_rule.h"

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// A TOML document with the name of its file, for messages.
struct SceneText {
  std::filesystem::path file;
  toml::table root;
  ContentHash hash;  ///< of this file, then of the meshes read for it

  /// Parses the content of a file.
  /// @throws InputError  it is not TOML, or nested too deeply for the parser
  SceneText(const std::filesystem::path& name, std::string_view content);

  [[noreturn]] void fail(const toml::source_region& at, const std::string& what) const {
    throw InputError(file.string() + ":" + std::to_string(at.begin.line) + ":" +
                     std::to_string(at.begin.column) + ": " + what);
  }
  [[noreturn]] void fail(const toml::node& at, const std::string& what) const {
    fail(at.source(), what);
  }
};

/// Checks that a table has only known keys.
/// @param where  name of the table, for messages
/// @throws InputError  it has another key
void requireKnownKeys(const SceneText& text, const toml::table& table, const std::string& where,
                      std::initializer_list<std::string_view> known);

// Each function returns the value of a node.
// @param name  of the key, for messages
// @throws InputError  the node has another type, or its value is out of range

const toml::table& requireTable(const SceneText& text, const toml::node& node,
                                const std::string& name);
const toml::array& requireArray(const SceneText& text, const toml::node& node,
                                const std::string& name);
/// A string without NUL characters.
std::string requireString(const SceneText& text, const toml::node& node, const std::string& name);
bool requireBoolean(const SceneText& text, const toml::node& node, const std::string& name);
/// A number of at most kMaxCoordinate in size.
double requireNumber(const SceneText& text, const toml::node& node, const std::string& name);
/// A whole number from low to high.
std::int64_t requireInteger(const SceneText& text, const toml::node& node, const std::string& name,
                            std::int64_t low, std::int64_t high);
/// Three numbers.
Vec3d requireVector(const SceneText& text, const toml::node& node, const std::string& name);
/// "voxel", or a table with one or more of { levels = 3, diameter = 4, angle = 5, flatness = 0.1 }.
StopRule requireStopRule(const SceneText& text, const toml::node& node);
/// A table with one or both of { below = 100, size = 0.5 }.
ComponentLimit requireComponentLimit(const SceneText& text, const toml::node& node);

/// Reads a value of an enumeration, given by its name. Leaves `value` unchanged if the table does
/// not have the key.
/// @throws InputError  no value has this name
template <class Enum, std::size_t N>
void readNamed(const SceneText& text, const toml::table& table, const char* key,
               const NameTable<Enum, N>& names, std::optional<Enum>& value) {
  const auto* node = table.get(key);
  if (node == nullptr) return;
  const std::string name = requireString(text, *node, key);
  value = namedIn(names, name);
  if (!value)
    text.fail(*node,
              std::string(key) + " must be one of " + allNamesIn(names) + ", not " + quote(name));
}

}  // namespace vox
