// Between colours as files store them and linear light.

#include "libvox/core/color.h"

#include <cmath>

namespace vox {

double linearFromScreen(double value) {
  constexpr double kEndOfStraightPart = 0.04045;
  if (value <= kEndOfStraightPart) return value / 12.92;
  return std::pow((value + 0.055) / 1.055, 2.4);
}

double screenFromLinear(double light) {
  constexpr double kEndOfStraightPart = 0.0031308;
  if (light <= kEndOfStraightPart) return 12.92 * light;
  return 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace vox
