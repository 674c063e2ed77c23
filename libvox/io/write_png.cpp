// PNG by libpng's simplified interface, which reports errors without longjmp.

#include "libvox/io/write_png.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <ostream>
#include <png.h>
#include <string>

namespace vox {
namespace {

constexpr std::uint8_t kCovered = 255;

bool isGrey(const Pixel& pixel) {
  return pixel[0] == pixel[1] && pixel[1] == pixel[2];
}

/// The channels that the PNG is to have, pixel after pixel.
std::vector<std::uint8_t> packed(const Image& image, bool colour, bool alpha) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * (colour ? 3 : 1) + (alpha ? image.pixels.size() : 0));
  for (const Pixel& pixel : image.pixels) {
    bytes.insert(bytes.end(), pixel.begin(), pixel.begin() + (colour ? 3 : 1));
    if (alpha) bytes.push_back(pixel[3]);
  }
  return bytes;
}

}  // namespace

void writePng(std::ostream& stream, const Image& image) {
  const bool colour = !std::all_of(image.pixels.begin(), image.pixels.end(), isGrey);
  const bool alpha = std::any_of(image.pixels.begin(), image.pixels.end(),
                                 [](const Pixel& pixel) { return pixel[3] != kCovered; });
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = (colour ? PNG_FORMAT_FLAG_COLOR : 0U) | (alpha ? PNG_FORMAT_FLAG_ALPHA : 0U);
  const std::vector<std::uint8_t> pixels = packed(image, colour, alpha);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<char> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, /*convert_to_8_bit=*/0, pixels.data(),
                                /*row_stride=*/0, /*colormap=*/nullptr) == 0)
    throw IoError(std::string("libpng cannot write the image: ") + png.message);
  if (!stream.write(bytes.data(), static_cast<std::streamsize>(size)).flush())
    throw IoError("the output cannot be written; is the disk full?");
}

}  // namespace vox
