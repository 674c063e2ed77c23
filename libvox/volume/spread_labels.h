#pragma once

#include "libvox/grid/openvdb.h"

#include <cstdint>

namespace vox {

class Progress;

/// Gives labels to the active voxels of a tree that have none, so that the voxels of a solid have
/// the labels of its surface. They are reached layer by layer, through faces, edges and corners. A
/// voxel takes the label of the source nearest to it among the sources of its neighbours of earlier
/// layers; sources are the voxels that had a label at first. Of equally near sources it takes the
/// one that comes first in the tree. Parallel; the result does not depend on threads.
///
/// @param labels  without active tiles; a voxel without a label has 0, and keeps it if no source
///                leads to it
/// @throws LimitError  there are 2^31 - 1 sources or more
/// @throws Cancelled
void spreadLabels(openvdb::Int32Tree& labels, const Progress& progress);

/// Bytes that spreadLabels needs besides the tree.
/// @param leaves   of the tree
/// @param sources  number of voxels with labels
std::uint64_t bytesOfSpreading(std::uint64_t leaves, std::uint64_t sources);

}  // namespace vox
