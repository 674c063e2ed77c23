// From colours as files store them to linear light.

#include "libvox/core/color.h"

#include <cmath>

namespace vox {

double linearFromScreen(double value) {
  constexpr double kEndOfStraightPart = 0.04045;
  if (value <= kEndOfStraightPart) return value / 12.92;
  return std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace vox
