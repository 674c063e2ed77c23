// Texts cut into blocks of whole lines, for parallel reading.

#include "libvox/io/text_blocks.h"

#include <algorithm>

namespace vox {

namespace {

/// The place after the first line end at `from` or later that surely ends a line.
std::size_t afterLineEnd(std::string_view text, std::size_t from) {
  for (;;) {
    const auto isLineEnd = [](char c) { return c == '\n' || c == '\r'; };
    const auto found =
        std::find_if(text.begin() + static_cast<std::ptrdiff_t>(from), text.end(), isLineEnd);
    if (found == text.end()) return text.size();
    const auto end = static_cast<std::size_t>(found - text.begin());
    const bool isCrLf = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
    const std::size_t next = end + (isCrLf ? 2 : 1);
    // The byte before `from` may be the CR of a CRLF, or a backslash.
    const char before = end > 0 ? text[end - 1] : ' ';
    if (before != '\\' && !(before == '\r' && end > 1 && text[end - 2] == '\\')) return next;
    from = next;
  }
}

}  // namespace

std::vector<std::string_view> lineBlocks(std::string_view text, std::size_t bytesPerBlock) {
  std::vector<std::string_view> blocks;
  while (!text.empty()) {
    const std::size_t size =
        text.size() <= bytesPerBlock ? text.size() : afterLineEnd(text, bytesPerBlock - 1);
    blocks.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return blocks;
}

std::size_t lineEndCount(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1)) ++count;
  for (std::size_t at = text.find('\r'); at != text.npos; at = text.find('\r', at + 1))
    if (at + 1 == text.size() || text[at + 1] != '\n') ++count;
  return count;
}

}  // namespace vox
