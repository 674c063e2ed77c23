#pragma once

#include "libvox/grid/openvdb.h"

namespace vox {

class Progress;

/// Gives each active voxel without a label, 0, that of a labelled voxel near it: the nearest one up
/// to about a voxel. Labels spread layer by layer through active voxels. A voxel takes the nearest
/// of the sources from which its 26 neighbours have theirs; of equally near ones the first in the
/// order of the tree. Voxels that no label reaches keep 0.
///
/// Cost O(n) for n leaves. Parallel; result independent of thread count.
/// @param labels  without tiles
/// @throws Cancelled
void spreadLabels(openvdb::Int32Tree& labels, const Progress& progress);

}  // namespace vox
