#pragma once

#include <cstdint>

namespace vox {

class Progress;

/// Resources of a run. The result does not depend on them.
struct RunOptions {
  std::uint64_t maxMemory = 0;   ///< bytes for meshes, images and grids; 0: 3/4 of what is free
  int threads = 0;               ///< 0: all processors
  Progress* progress = nullptr;  ///< is told how far the run is; may cancel it
};

}  // namespace vox
