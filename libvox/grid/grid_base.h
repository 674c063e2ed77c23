#pragma once

#include <openvdb/version.h>

// Forward declaration of openvdb::GridBase. Code that uses a grid includes <openvdb/openvdb.h>.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {
class GridBase;
}
}  // namespace openvdb
