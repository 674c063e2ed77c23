#pragma once

#include "apps/bench/inputs.h"

#include <string>
#include <vector>

namespace vox::bench {

/// Registers timings of the engine for every generated mesh, and for mesh files.
void registerEngine(const std::vector<std::string>& meshFiles);

}  // namespace vox::bench
