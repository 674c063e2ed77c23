#pragma once

#include <cstdint>
#include <string>

namespace vox::app {

/// "1 voxel", "2 voxels".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// "1 vertex", "2 vertices".
inline std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace vox::app
