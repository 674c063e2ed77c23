#pragma once

namespace vox::bench {

/// Registers timings of a picture of 1024 x 1024 pixels of a model of 1024 voxels.
void registerRender();

}  // namespace vox::bench
