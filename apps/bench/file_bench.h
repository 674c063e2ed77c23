#pragma once

namespace vox::bench {

/// Registers timings of files and of their floors: the same bytes without OpenVDB, and memory.
void registerFiles();

}  // namespace vox::bench
