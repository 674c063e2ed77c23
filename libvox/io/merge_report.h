#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// A grid of a merged file.
struct MergedGrid {
  std::string name;
  std::uint64_t activeVoxels = 0;
};

/// What was merged.
struct MergeReport {
  std::vector<MergedGrid> grids;
  int partCount = 0;         ///< parts of the conversion; 0: the files are no parts
  std::vector<int> missing;  ///< their numbers, from 1
};

/// "part 3", "parts 3, 5-8": numbers that ascend.
std::string partsText(const std::vector<int>& numbers);

}  // namespace vox
