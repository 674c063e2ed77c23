#pragma once

namespace vox::bench {

/// Registers benchmarks of a picture of 1024 x 1024 pixels of a model at dim 1024.
void registerRender();

}  // namespace vox::bench
