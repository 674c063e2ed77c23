#pragma once

namespace vox {

/// One of several runs that together make the grids of one conversion. Each makes those of some
/// pages (grid/pages.h).
struct RunPart {
  int number = 1;  ///< from 1
  int count = 1;
};

inline constexpr int kMostRunParts = 1'000'000;

/// Names of the metadata of grids of such a run: its number, and how many there are. Int32.
inline constexpr const char* kRunPartMetadata = "vox_part";
inline constexpr const char* kRunPartsMetadata = "vox_parts";
/// The parts that a merged file lacks, as text.
inline constexpr const char* kMissingPartsMetadata = "vox_missing_parts";

}  // namespace vox
