// Limits of components as text.

#include "libvox/options/component_limit.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>

namespace vox {
namespace {

/// A number of 0 or more.
template <class Number>
bool readWhole(std::string_view text, std::optional<Number>& value) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return false;
  if (!(number >= 0) || !std::isfinite(static_cast<double>(number))) return false;
  value = number;
  return true;
}

bool readLimit(std::string_view text, ComponentLimit& limit) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos) return false;
  const std::string_view key = text.substr(0, equals);
  const std::string_view value = text.substr(equals + 1);
  if (key == "below") return readWhole(value, limit.below);
  return key == "size" && readWhole(value, limit.size);
}

}  // namespace

std::optional<ComponentLimit> componentLimitIn(std::string_view text) {
  ComponentLimit limit;
  while (true) {
    const std::size_t comma = text.find(',');
    if (!readLimit(text.substr(0, comma), limit)) return std::nullopt;
    if (comma == text.npos) return limit;
    text.remove_prefix(comma + 1);
  }
}

std::string componentLimitText(const ComponentLimit& limit) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  if (limit.below) text << "below=" << *limit.below;
  if (limit.below && limit.size) text << ',';
  if (limit.size) text << "size=" << *limit.size;
  return text.str();
}

}  // namespace vox
