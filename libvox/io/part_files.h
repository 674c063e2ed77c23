#pragma once

#include "libvox/io/vdb_index.h"

#include <span>
#include <vector>

namespace vox {

/// True if every grid of the file says which part of a conversion it is.
bool isPartFile(const VdbIndex& file);

/// Part files of one conversion.
struct PartFiles {
  std::vector<VdbIndex> parts;  ///< in the order of their numbers
  std::vector<int> missing;     ///< numbers
  int count = 0;                ///< of parts in all, if all are as small as the smallest
};

/// Orders files for which isPartFile is true, and checks that they belong together: the same input,
/// options, version and grids, and no part twice. Part I of N stands for parts 2I - 1 and 2I of 2N,
/// and so on. If some files do not fit, the error names one of the smaller group.
/// @param files  not empty
/// @throws InputError  they do not; the message names a file
PartFiles orderedParts(std::vector<VdbIndex> files);

/// Metadata of the whole, made of those of its parts: number of voxels (sum) and of levels (most),
/// without the number of the part and without the statistics of the tree. All others are the same
/// where a part has them.
/// @param metadata  of `files`, in the same order
/// @throws InputError  they are not; the message names a file
openvdb::MetaMap metadataOfWhole(std::span<const VdbIndex> files,
                                 std::span<const openvdb::MetaMap* const> metadata);

}  // namespace vox
