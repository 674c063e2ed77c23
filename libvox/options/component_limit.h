#pragma once

#include "libvox/core/types.h"

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// Which components of a mesh are debris. A component is debris if it is below one of the limits.
struct ComponentLimit {
  std::optional<Index> below = {};  ///< faces
  std::optional<double> size = {};  ///< diagonal of its box, world units; 0 or more

  bool dropsNothing() const { return below.value_or(0) == 0 && size.value_or(0) == 0; }
  bool operator==(const ComponentLimit&) const = default;
};

/// Reads "below=N", "size=X", or both with a comma. Nothing if the text is not valid.
std::optional<ComponentLimit> componentLimitIn(std::string_view text);

/// The text that componentLimitIn reads.
std::string componentLimitText(const ComponentLimit& limit);

}  // namespace vox
