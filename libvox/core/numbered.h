#pragma once

#include "libvox/core/types.h"

#include <cstddef>
#include <numeric>
#include <vector>

namespace vox {

/// The numbers 0, 1, ..., count - 1.
inline std::vector<Index> numbered(std::size_t count) {
  std::vector<Index> numbers(count);
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

}  // namespace vox
