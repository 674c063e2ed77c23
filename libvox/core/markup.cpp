// Texts in XML and HTML. Source: XML 1.0, section 2.2; RFC 3629, section 4.

#include "libvox/core/markup.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace vox {
namespace {

/// Bytes of the character that begins a text, if it is well-formed UTF-8 and XML may have it; else
/// 0.
std::size_t characterBytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  constexpr unsigned kDelete = 0x7F;
  if (first < kDelete)
    return first >= ' ' || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t count = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < count) return 0;
  std::uint32_t code = first & (0x7FU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool isSurrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool isLast = code == 0xFFFE || code == 0xFFFF;
  return code < kLeast.at(count) || code > 0x10FFFF || isSurrogate || isLast ? 0 : count;
}

std::string_view entityOf(char c, bool isValue) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\r':
      return "&#13;";
    case '\n':
      return isValue ? "&#10;" : "";
    case '\t':
      return isValue ? "&#9;" : "";
    default:
      return {};
  }
}

std::string withEntities(std::string_view text, bool isValue) {
  std::string all;
  while (!text.empty()) {
    const std::size_t count = characterBytes(text);
    const std::string_view entity = entityOf(text[0], isValue);
    all += count == 0 ? "\xEF\xBF\xBD" : entity.empty() ? text.substr(0, count) : entity;
    text.remove_prefix(std::max<std::size_t>(count, 1));
  }
  return all;
}

}  // namespace

std::string escaped(std::string_view text) {
  return withEntities(text, false);
}

std::string escapedValue(std::string_view text) {
  return '"' + withEntities(text, true) + '"';
}

}  // namespace vox
