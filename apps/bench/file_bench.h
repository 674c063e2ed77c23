#pragma once

namespace vox::bench {

/// Registers benchmarks of files, and of their lower bounds: the same bytes without OpenVDB, and in
/// memory.
void registerFiles();

}  // namespace vox::bench
