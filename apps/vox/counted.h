#pragma once

#include <cstdint>
#include <string>

namespace vox::app {

/// "1 voxel", "2 voxels".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace vox::app
