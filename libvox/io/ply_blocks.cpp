// PLY bodies cut into blocks, for parallel reading.

#include "libvox/io/ply_blocks.h"

#include "libvox/core/parallel.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/text_blocks.h"

#include <cstring>
#include <type_traits>
#include <utility>

namespace vox {

namespace {

// The sizes of the binary records of a kind of elements.
class RecordSizes {
 public:
  RecordSizes(const PlyElement& element, std::endian order) : element_(element), order_(order) {}

  // The size of the record that `bytes` start with; nothing: it is cut, or a count is negative or
  // no integer. Calls onCount(offset, size) for the count of each list.
  template <typename OnCount>
  std::optional<std::size_t> sizeOfFirst(std::string_view bytes, OnCount&& onCount) const {
    std::size_t size = 0;
    for (const PlyProperty& property : element_.properties) {
      std::uint64_t items = 1;
      if (property.isList) {
        const std::size_t countSize = sizeOf(property.countType);
        if (bytes.size() - size < countSize) return std::nullopt;
        const auto count = plyListCount(bytes.data() + size, property.countType, order_);
        if (!count || *count < 0) return std::nullopt;
        onCount(size, countSize);
        size += countSize;
        items = static_cast<std::uint64_t>(*count);
      }
      if (items > (bytes.size() - size) / sizeOf(property.type)) return std::nullopt;
      size += items * sizeOf(property.type);
    }
    return size;
  }

  // The size of all records, if it is the same; as it is without lists, and mostly with them.
  std::optional<std::size_t> commonSize(std::string_view bytes) const {
    std::vector<std::pair<std::size_t, std::size_t>> counts;
    const auto size = sizeOfFirst(bytes, [&](std::size_t offset, std::size_t countSize) {
      counts.emplace_back(offset, countSize);
    });
    if (!size || element_.count > bytes.size() / *size) return std::nullopt;
    constexpr std::size_t kRecordsPerTask = 1 << 14;
    const bool isCommon =
        counts.empty() ||
        lowestWhere(element_.count, kRecordsPerTask, [&](std::uint64_t e) {
          return std::any_of(counts.begin(), counts.end(), [&](const auto& count) {
            return std::memcmp(bytes.data() + count.first, bytes.data() + e * *size + count.first,
                               count.second) != 0;
          });
        }) == element_.count;
    return isCommon ? size : std::nullopt;
  }

 private:
  const PlyElement& element_;
  std::endian order_;
};

// Cuts all elements of one kind into blocks of about bytesPerBlock. Removes their bytes from
// `bytes`. False: they are damaged.
bool cutElements(const PlyElement& element, std::endian order, std::size_t bytesPerBlock,
                 std::uint64_t first, std::string_view& bytes, std::vector<PlyBlock>& blocks) {
  if (element.count == 0) return true;
  const RecordSizes sizes(element, order);
  const auto add = [&](std::uint64_t from, std::uint64_t to, std::size_t size) {
    blocks.push_back({first + from, first + to, bytes.substr(0, size), 0});
    bytes.remove_prefix(size);
  };
  if (const auto size = sizes.commonSize(bytes)) {
    const std::uint64_t step = std::max<std::uint64_t>(bytesPerBlock / *size, 1);
    for (std::uint64_t from = 0; from < element.count; from += step) {
      const std::uint64_t to = std::min(element.count, from + step);
      add(from, to, *size * (to - from));
    }
    return true;
  }
  std::uint64_t from = 0;
  std::size_t sum = 0;
  for (std::uint64_t e = 0; e < element.count; ++e) {
    const auto size = sizes.sizeOfFirst(bytes.substr(sum), [](std::size_t, std::size_t) {});
    if (!size) return false;
    sum += *size;
    if (sum < bytesPerBlock && e + 1 < element.count) continue;
    add(std::exchange(from, e + 1), e + 1, std::exchange(sum, 0));
  }
  return true;
}

// The blocks of a binary body; none if it is damaged.
std::vector<PlyBlock> binaryBlocks(const PlyHeader& header, std::string_view bytes,
                                   std::size_t bytesPerBlock) {
  std::vector<PlyBlock> blocks;
  std::uint64_t first = 0;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;
    if (!cutElements(element, *header.binaryOrder, bytesPerBlock, first, bytes, blocks)) return {};
    first += element.count;
  }
  return blocks;
}

// The blocks of a text body whose lines hold one element each.
std::vector<PlyBlock> textBlocks(const PlyHeader& header, const TextScanner& scan,
                                 std::size_t bytesPerBlock) {
  const std::vector<std::string_view> texts = lineBlocks(scan.rest(), bytesPerBlock);
  std::vector<std::size_t> lineCounts(texts.size());
  parallelForEach(texts.size(), 1, [&](std::size_t b) {
    const bool endsLine = texts[b].ends_with('\n') || texts[b].ends_with('\r');
    lineCounts[b] = lineEndCount(texts[b]) + (endsLine ? 0 : 1);
  });
  const std::uint64_t count = elementCount(header);
  std::vector<PlyBlock> blocks;
  std::uint64_t first = 0;
  for (std::size_t b = 0; b < texts.size() && first < count; ++b) {
    const std::uint64_t end = std::min(count, first + lineCounts[b]);
    blocks.push_back({first, end, texts[b], scan.line() + first});
    first = end;
  }
  if (first < count) return {};
  return blocks;
}

}  // namespace

std::uint64_t elementCount(const PlyHeader& header) {
  std::uint64_t count = 0;
  for (const PlyElement& element : header.elements)
    if (!element.properties.empty()) count += element.count;
  return count;
}

std::optional<std::int64_t> plyListCount(const char* bytes, PlyType type, std::endian order) {
  return withType(type, [&](auto zero) -> std::optional<std::int64_t> {
    if constexpr (std::is_integral_v<decltype(zero)>)
      return loadNumber<decltype(zero)>(bytes, order);
    return std::nullopt;
  });
}

std::vector<PlyBlock> plyBlocks(const PlyHeader& header, const TextScanner& scan,
                                std::size_t bytesPerBlock) {
  return header.binaryOrder ? binaryBlocks(header, scan.rest(), bytesPerBlock)
                            : textBlocks(header, scan, bytesPerBlock);
}

}  // namespace vox
