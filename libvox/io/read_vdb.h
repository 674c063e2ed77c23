#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vox {

/// A grid and the name that is its own within its file: "density", or "density[1]" for the second
/// of that name.
struct NamedGrid {
  std::string name;
  openvdb::GridBase::Ptr grid;
};

struct VdbFile {
  std::vector<NamedGrid> grids;  ///< in file order; values of leaves are loaded when looked at
  openvdb::MetaMap metadata;     ///< of the file
};

/// Opens a .vdb file of any program.
/// @throws InputError  missing, not a .vdb file that OpenVDB can read, or one of ours that is
/// damaged
VdbFile readVdb(const std::filesystem::path& file);

/// Reads one grid after the other, so that only one is in memory at a time.
/// @throws InputError  as readVdb
void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit);

}  // namespace vox
