#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vox {

/// Red, green and blue (sRGB, not multiplied by coverage), and coverage.
using Pixel = std::array<std::uint8_t, 4>;

/// Picture; rows from top to bottom, pixels of a row from left to right.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels;

  Image() = default;
  Image(int columns, int rows)
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

  Pixel& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Pixel& at(int x, int y) const { return const_cast<Image&>(*this).at(x, y); }
};

}  // namespace vox
