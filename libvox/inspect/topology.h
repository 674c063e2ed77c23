#pragma once

#include "libvox/grid/openvdb.h"

namespace vox {

/// Types of grids that can be compared and checked: all of OpenVDB's own but points.
using ComparedTypes = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                        openvdb::Int64Grid, openvdb::Vec3IGrid, openvdb::Vec3SGrid,
                                        openvdb::Vec3DGrid, openvdb::BoolGrid, openvdb::MaskGrid>;

/// @throws InputError  always: the grid is of another type
[[noreturn]] void refuseType(const openvdb::GridBase& grid);

/// The active voxels of a grid of any of these types.
/// @throws InputError  another type
openvdb::MaskTree::Ptr topologyOf(const openvdb::GridBase& grid);

}  // namespace vox
