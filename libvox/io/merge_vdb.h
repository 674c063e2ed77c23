#pragma once

#include "libvox/io/merge_report.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace vox {

struct MergeOptions {
  bool partial = false;         ///< parts may be missing
  std::uint64_t maxMemory = 0;  ///< bytes; 0: three quarters of what is available
};

/// Writes one .vdb file made of several: the whole of the parts of a conversion (mergeParts), or
/// the union of other files (unitedGrids).
///
/// @param stream  empty, readable, writable and seekable
/// @param files   not empty
/// @throws InputError  a file cannot be read, the files do not belong together, a part is missing,
///   or there is no grid; nothing has been written then, unless voxels of parts overlap
/// @throws LimitError  the work needs more memory
/// @throws IoError     the stream fails
MergeReport mergeVdb(std::iostream& stream, const std::vector<std::filesystem::path>& files,
                     const MergeOptions& options = {});

}  // namespace vox
