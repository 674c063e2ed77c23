// The colours of differences.

#include "libvox/report/palette.h"

#include "libvox/core/color.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace vox {

Pixel valueColor(double part) {
  const double t = part > 0 ? std::min(part, 1.0) : 0;
  Pixel color = kSmallColor;
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = static_cast<std::uint8_t>(
        std::lround((1 - t) * kSmallColor[i] + t * static_cast<double>(kLargeColor[i])));
  return color;
}

openvdb::Vec3f linearColor(const Pixel& color) {
  constexpr double kMost = 255;
  const auto linear = [&](std::size_t i) {
    return static_cast<float>(linearFromScreen(color[i] / kMost));
  };
  return {linear(0), linear(1), linear(2)};
}

std::string cssColor(const Pixel& color) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", color[0], color[1], color[2]);
  return text.data();
}

}  // namespace vox
