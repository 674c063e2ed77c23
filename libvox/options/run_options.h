#pragma once

#include <cstdint>

namespace vox {

class Progress;

/// What a run may use; the result does not depend on it.
struct RunOptions {
  std::uint64_t maxMemory = 0;   ///< bytes for meshes and grids; 0: three quarters of what is free
  int threads = 0;               ///< 0: all processors
  Progress* progress = nullptr;  ///< told how far the run is; may cancel it
};

}  // namespace vox
