#pragma once

#include "libvox/io/ply_header.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace vox {

/// Consecutive elements of a PLY body, with the bytes they start with. Elements of all kinds are
/// counted together; those without properties have no bytes, and do not count.
struct PlyBlock {
  std::uint64_t first;
  std::uint64_t end;
  std::string_view bytes;
  std::size_t line;  ///< that the bytes start with, in a text
};

/// Number of elements of all kinds.
std::uint64_t elementCount(const PlyHeader& header);

/// Calls body(element, first, end) for the elements of each kind in [first, end) of a PlyBlock.
template <typename Body>
void forEachKind(const PlyHeader& header, std::uint64_t first, std::uint64_t end, Body&& body) {
  std::uint64_t start = 0;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;
    const std::uint64_t from = std::clamp(first, start, start + element.count) - start;
    const std::uint64_t to = std::clamp(end, start, start + element.count) - start;
    if (from < to) body(element, from, to);
    start += element.count;
  }
}

/// The count of a binary list; nothing: its type is no integer.
std::optional<std::int64_t> plyListCount(const char* bytes, PlyType type, std::endian order);

/// Cuts a body into blocks of about `bytesPerBlock`, which can be read independently. None if it is
/// damaged. The binary blocks hold one kind of elements each. Of a text, the blocks are right only
/// if each element has a line of its own; if not, one of them ends before the last of its elements.
/// @param scan  stands at the start of the body
std::vector<PlyBlock> plyBlocks(const PlyHeader& header, const TextScanner& scan,
                                std::size_t bytesPerBlock);

}  // namespace vox
