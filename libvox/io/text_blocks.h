#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace vox {

/// Cuts a text at ends of lines into blocks of at least `bytesPerBlock` (which is at least 1), the
/// last one excepted. A line whose last character is a backslash stays with the next line, since it
/// may be joined with it.
std::vector<std::string_view> lineBlocks(std::string_view text, std::size_t bytesPerBlock);

/// Number of line ends: LF, CRLF or CR.
std::size_t lineEndCount(std::string_view text);

}  // namespace vox
