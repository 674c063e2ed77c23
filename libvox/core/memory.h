#pragma once

#include <cstdint>
#include <string>

namespace vox {

/// Bytes this process may still allocate: what the system reports as available, within the limits
/// of its control group and address space.
std::uint64_t availableMemory();

/// "1.5 GiB".
std::string formatBytes(std::uint64_t bytes);

}  // namespace vox
