// Text files of indices.

#include "libvox/io/read_indices.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/text_scanner.h"

#include <string>

namespace vox {

std::vector<Index> readIndices(const std::filesystem::path& file) {
  const FileContent content = contentsOf(file);
  TextScanner text(content, file.string(), {.hashComments = true});
  std::vector<Index> indices;
  for (auto token = text.tokenOnAnyLine(); !token.empty(); token = text.tokenOnAnyLine()) {
    const std::int64_t index = text.integer(token);
    if (index < 0 || index >= std::int64_t{kNone})
      text.fail("an index must lie between 0 and " + std::to_string(kNone - 1) + ", not " +
                std::to_string(index));
    indices.push_back(static_cast<Index>(index));
  }
  return indices;
}

std::vector<PointPair> readIndexPairs(const std::filesystem::path& file) {
  const std::vector<Index> indices = readIndices(file);
  if (indices.size() % 2 != 0)
    throw InputError(file.string() + ": has " + std::to_string(indices.size()) +
                     " numbers, but pairs are wanted: two vertices for each edge");
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < indices.size(); i += 2) pairs.push_back({indices[i], indices[i + 1]});
  return pairs;
}

}  // namespace vox
