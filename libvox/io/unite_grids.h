#pragma once

#include "libvox/io/read_vdb.h"
#include "libvox/io/vdb_index.h"

#include <cstdint>
#include <span>

namespace vox {

/// The grids of some files, in the order of their first appearance. Grids of one name become one:
/// masks their union, level sets the union of what is inside, other floats the larger value. They
/// must share type, class, background and transform. Metadata stay where all have the same. A grid
/// that only one file has may be of any type.
///
/// @param files      not empty; those of other programs without grids in the index. Their grids are
///   in the order in which OpenVDB reads them.
/// @param maxMemory  bytes; 0: three quarters of what is available
/// @throws InputError  a file cannot be read, or grids of one name cannot be united
/// @throws LimitError  the grids need more memory
VdbFile unitedGrids(std::span<const VdbIndex> files, std::uint64_t maxMemory = 0);

}  // namespace vox
