// Keeps messages on one line, even when they quote a file name or a token with line ends.

#include "libvox/core/error.h"

#include <algorithm>

namespace vox {

std::string onOneLine(std::string text) {
  const auto isControl = [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), isControl, '?');
  return text;
}

}  // namespace vox
