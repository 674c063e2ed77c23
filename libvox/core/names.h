#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace vox {

/// Names of the values of an enumeration, in scenes and on the command line.
template <class Enum, std::size_t N>
using NameTable = std::array<std::pair<Enum, std::string_view>, N>;

/// Name of the value; empty if the table does not hold it.
template <class Enum, std::size_t N>
std::string nameIn(const NameTable<Enum, N>& table, Enum value) {
  for (const auto& [known, name] : table)
    if (known == value) return std::string(name);
  return {};
}

/// Value of the name; nothing if the table does not hold it.
template <class Enum, std::size_t N>
std::optional<Enum> namedIn(const NameTable<Enum, N>& table, std::string_view name) {
  for (const auto& [value, known] : table)
    if (known == name) return value;
  return std::nullopt;
}

/// All names in the order of the table, as messages list them: "surface, solid".
template <class Enum, std::size_t N>
std::string allNamesIn(const NameTable<Enum, N>& table) {
  std::string names;
  for (const auto& [value, name] : table) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

}  // namespace vox
