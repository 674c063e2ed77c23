#pragma once

#include <array>
#include <cstdint>

namespace vox {

/// Number of vertices of each level.
using LevelCounts = std::array<std::uint64_t, 128>;

}  // namespace vox
