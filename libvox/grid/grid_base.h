#pragma once

#include <openvdb/version.h>

// Only named here: a translation unit that looks into a grid includes <openvdb/openvdb.h> itself.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {
class GridBase;
}
}  // namespace openvdb
