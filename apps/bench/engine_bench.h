#pragma once

#include "apps/bench/inputs.h"

#include <string>
#include <vector>

namespace vox::bench {

/// Registers benchmarks of the engine: on all generated meshes, and on mesh files.
void registerEngine(const std::vector<std::string>& meshFiles);

}  // namespace vox::bench
