#pragma once

#include "libvox/core/names.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>

namespace vox::app {

/// Keys keep the order in which they are added.
using Json = nlohmann::ordered_json;

/// JSON as the program prints it. Text that is no UTF-8 is replaced.
inline std::string textOf(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// The value, or null if it is not set.
template <class Value>
Json orNull(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

/// Its name, or null.
template <class Enum, std::size_t N>
Json orNull(const NameTable<Enum, N>& names, const std::optional<Enum>& value) {
  return value ? Json(nameIn(names, *value)) : Json();
}

}  // namespace vox::app
