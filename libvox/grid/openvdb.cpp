// Functions of OpenVDB's trees and grids that its library has only inlined.

#include "libvox/grid/openvdb.h"

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template MaskGrid::Ptr Grid<MaskTree>::create(const bool&);
template MaskGrid::Ptr Grid<MaskTree>::create(MaskTree::Ptr);

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
