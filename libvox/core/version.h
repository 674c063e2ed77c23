#pragma once

namespace vox {

/// Version of libvox, as written into the metadata of its grids: "0.1.0".
const char* version() noexcept;

}  // namespace vox
