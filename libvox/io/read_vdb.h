#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vox {

/// A grid and the name that is its own within its file: "density", or "density[1]" for the second
/// of that name.
struct NamedGrid {
  std::string name;
  std::shared_ptr<openvdb::GridBase> grid;
};

struct VdbFile {
  std::vector<NamedGrid> grids;
  std::shared_ptr<const openvdb::MetaMap> metadata;  ///< of the file
};

/// Opens a .vdb file of any program. Values are loaded on demand from files of ours, whose hash
/// shows them to be whole, and from large ones; of others all is read.
/// @throws InputError  missing, not a .vdb file that OpenVDB can read, or one of ours but damaged
VdbFile readVdb(const std::filesystem::path& file);

/// Looks at one grid after the other; those loaded on demand are in memory one at a time.
/// @throws InputError  as readVdb
void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit);

}  // namespace vox
