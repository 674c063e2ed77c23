#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace vox {

/// Reads a NanoVDB file (version 32) from any program, grid after grid: of numbers, vectors of
/// three, masks and quantised floats. Nothing of it is trusted: sizes, offsets and nodes are
/// checked before they are used, and checksums as NanoVDB does it.
/// @param visit  receives each grid, with its name, class and transform
/// @throws InputError  the file is missing, damaged, or of a version or type that is not read
/// @throws LimitError  a grid does not fit into memory
void readNvdb(const std::filesystem::path& file,
              const std::function<void(const std::shared_ptr<openvdb::GridBase>&)>& visit);

}  // namespace vox
