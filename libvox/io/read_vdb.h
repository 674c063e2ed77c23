#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vox {

/// A grid with a name that is unique in its file: "density", or "density[1]" for the second grid
/// called "density".
struct NamedGrid {
  std::string name;
  std::shared_ptr<openvdb::GridBase> grid;
};

struct VdbFile {
  std::vector<NamedGrid> grids;
  std::shared_ptr<const openvdb::MetaMap> metadata;  ///< of the file
};

/// Reads a .vdb or .nvdb file (isGridFile) from any program. NanoVDB files have no metadata,
/// neither of the file nor of grids, and are read now. Of OpenVDB files values are loaded on demand
/// if libvox wrote the file and its hash is right, or if it is larger than 256 MiB; otherwise the
/// whole file is read now.
/// @throws InputError  the file is missing, OpenVDB or NanoVDB cannot read it, or libvox wrote it
/// and
///   it is damaged
/// @throws LimitError  a NanoVDB grid does not fit into memory
VdbFile readVdb(const std::filesystem::path& file);

/// Reads some grids of a file for which isSoundOwnVdb is true.
/// @param wants  called with the names of grids
VdbFile readOwnVdb(const std::filesystem::path& file,
                   const std::function<bool(const std::string&)>& wants);

/// Whether libvox wrote a .vdb file, and it is as it was written. Reads the whole file if so.
/// @throws InputError  the file is missing or no OpenVDB file, or libvox wrote it and it is damaged
bool isSoundOwnVdb(const std::filesystem::path& file);

/// Calls visit for one grid after the other. If values are loaded on demand (readVdb), only one
/// grid is in memory at a time.
/// @throws InputError  as readVdb
void forEachGrid(const std::filesystem::path& file,
                 const std::function<void(const NamedGrid&)>& visit);

}  // namespace vox
