// VOX_VERSION comes from the project() line of CMakeLists.txt.

#include "libvox/core/version.h"

namespace vox {

const char* version() noexcept {
  return VOX_VERSION;
}

}  // namespace vox
