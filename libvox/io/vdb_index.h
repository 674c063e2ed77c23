#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace vox {

/// One grid of a file: its head, and where the rest is.
struct VdbIndexGrid {
  std::shared_ptr<const openvdb::io::GridDescriptor> descriptor;
  std::shared_ptr<const openvdb::GridBase> head;  ///< metadata and transform, with an empty tree
  std::uint32_t compression = 0;                  ///< flags of openvdb/io/Compression.h
  std::int64_t treePosition = 0;                  ///< in the file: first nodes, then values
};

/// What a .vdb file holds, without nodes and values.
struct VdbIndex {
  std::filesystem::path file;
  std::uint32_t format = 0;                          ///< version of the file format
  std::shared_ptr<const openvdb::MetaMap> metadata;  ///< of the file
  std::vector<VdbIndexGrid> grids;                   ///< in the order of the file
};

/// Reads the index of a sound file of libvox (isSoundOwnVdb).
/// @throws InputError  the file cannot be read
VdbIndex readVdbIndex(const std::filesystem::path& file);

/// Reads a grid of the file without the values of its leaves, whose buffers stay empty: metadata,
/// transform, nodes, tiles, and which voxels of leaves are active.
/// @throws InputError  the file cannot be read
std::shared_ptr<openvdb::GridBase> readNodes(const VdbIndex& index, std::size_t grid);

/// Whether the nodes and values of two grids are the same bytes of their files, to be read in the
/// same way. Then the grids have the same voxels with the same values. Reads both, in parallel, and
/// holds a few blocks at a time.
/// @throws InputError  a file cannot be read
bool haveSameTree(const VdbIndex& a, std::size_t gridA, const VdbIndex& b, std::size_t gridB);

}  // namespace vox
