#include "libvox/io/write_png.h"

#include "libvox/core/error.h"

#include <catch2/catch.hpp>

#include <png.h>
#include <random>
#include <sstream>

using namespace vox;

namespace {

std::string pngOf(const Image& image) {
  std::ostringstream stream;
  writePng(stream, image);
  return stream.str();
}

/// The pixels of a PNG, read by libpng.
Image readPng(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0);
  png.format = PNG_FORMAT_RGBA;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  REQUIRE(png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) != 0);
  return image;
}

constexpr std::size_t kColourType = 25;  // byte of the header: 0 grey, 2 RGB, 4 and 6 with alpha

}  // namespace

TEST_CASE("pixels come back from a PNG of the smallest kind", "[io][golden]") {
  const auto [colour, alpha, type] = GENERATE(table<bool, bool, int>(
      {{false, false, 0}, {true, false, 2}, {false, true, 4}, {true, true, 6}}));
  CAPTURE(type);
  std::mt19937 random(1);
  Image image(7, 5);
  for (Pixel& pixel : image.pixels) {
    pixel.fill(static_cast<std::uint8_t>(random()));
    if (colour) pixel[1] = static_cast<std::uint8_t>(random());
    pixel[3] = alpha ? static_cast<std::uint8_t>(random()) : 255;
  }
  const std::string bytes = pngOf(image);
  CHECK(bytes[kColourType] == type);
  CHECK(readPng(bytes).pixels == image.pixels);
  CHECK(pngOf(image) == bytes);
}

TEST_CASE("a stream that fails while a PNG is written is an error", "[io][error]") {
  std::ostringstream stream;
  stream.setstate(std::ios::badbit);
  CHECK_THROWS_AS(writePng(stream, Image(2, 2)), IoError);
}
