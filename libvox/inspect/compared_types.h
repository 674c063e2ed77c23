#pragma once

#include "libvox/grid/openvdb.h"

namespace vox {

/// Types of grids that can be compared and checked: all of OpenVDB's own but points.
using ComparedTypes = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                        openvdb::Int64Grid, openvdb::Vec3IGrid, openvdb::Vec3SGrid,
                                        openvdb::Vec3DGrid, openvdb::BoolGrid, openvdb::MaskGrid>;

}  // namespace vox
