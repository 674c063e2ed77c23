#pragma once

#include "libvox/io/merge_report.h"
#include "libvox/io/part_files.h"

#include <cstdint>
#include <iosfwd>
#include <vector>

namespace vox {

/// Writes the file of which the files are parts: the very bytes that a conversion in one run
/// writes. The packed values of leaves are copied as they are. In memory are the nodes of one grid
/// at a time, without the values of its leaves.
///
/// @param stream     empty, readable, writable and seekable
/// @param maxMemory  bytes; 0: three quarters of what is available
/// @throws InputError  a file cannot be read, or its voxels overlap those of another one
/// @throws LimitError  the nodes need more memory
/// @throws IoError     the stream fails
std::vector<MergedGrid> mergeParts(std::iostream& stream, const PartFiles& files,
                                   std::uint64_t maxMemory = 0);

}  // namespace vox
