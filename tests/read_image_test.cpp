#include "libvox/io/read_image.h"

#include "libvox/core/error.h"
#include "libvox/io/write_png.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <jpeglib.h>
#include <random>
#include <sstream>
#include <vector>
#include <zlib.h>

using namespace vox;

namespace {

using namespace std::string_literals;

std::string bigEndian(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(number >> shift);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const uLong sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return bigEndian(static_cast<std::uint32_t>(data.size())) + checked +
         bigEndian(static_cast<std::uint32_t>(sum));
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string result(size, '\0');
  compress(reinterpret_cast<Bytef*>(result.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return result.substr(0, size);
}

constexpr int kGrey = 0;
constexpr int kRgb = 2;
constexpr int kPalette = 3;
constexpr int kGreyAlpha = 4;
constexpr int kRgba = 6;

int channelsOf(int type) {
  constexpr int kChannels[] = {1, 0, 3, 1, 2, 0, 4};
  return kChannels[type];
}

std::string header(std::uint32_t width, std::uint32_t height, int depth, int type,
                   bool interlaced = false) {
  return "\x89PNG\r\n\x1a\n"s +
         chunk("IHDR", bigEndian(width) + bigEndian(height) + static_cast<char>(depth) +
                           static_cast<char>(type) + "\0\0"s + static_cast<char>(interlaced));
}

/// Samples of an image, and the PNG made of them by hand.
struct Samples {
  int width, height, depth, type;
  std::vector<unsigned> values;  // channels of pixel after pixel, row after row

  unsigned at(int x, int y, int channel) const {
    return values[static_cast<std::size_t>((y * width + x) * channelsOf(type) + channel)];
  }

  /// Rows of every `stepX`-th pixel of every `stepY`-th row, each with filter 0.
  std::string rows(int fromX, int stepX, int fromY, int stepY) const {
    std::string bytes;
    for (int y = fromY; y < height && fromX < width; y += stepY) {
      bytes += '\0';
      unsigned buffer = 0;
      int bits = 0;
      const auto put = [&](unsigned value, int count) {
        buffer = buffer << static_cast<unsigned>(count) | value;
        bits += count;
        if (bits < 8) return;
        bytes += static_cast<char>(buffer);
        buffer = 0;
        bits = 0;
      };
      for (int x = fromX; x < width; x += stepX)
        for (int c = 0; c < channelsOf(type); ++c) {
          if (depth == 16) put(at(x, y, c) >> 8U, 8);
          put(at(x, y, c) & 0xFFU, std::min(depth, 8));
        }
      while (bits > 0) put(0, 1);
    }
    return bytes;
  }

  std::string png(bool interlaced, const std::string& between = "") const {
    std::string bytes;
    if (interlaced)
      for (const auto& [x, stepX, y, stepY] : {std::array{0, 8, 0, 8},
                                               {4, 8, 0, 8},
                                               {0, 4, 4, 8},
                                               {2, 4, 0, 4},
                                               {0, 2, 2, 4},
                                               {1, 2, 0, 2},
                                               {0, 1, 1, 2}})
        bytes += rows(x, stepX, y, stepY);
    else
      bytes = rows(0, 1, 0, 1);
    return header(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), depth,
                  type, interlaced) +
           between + chunk("IDAT", deflated(bytes)) + chunk("IEND", "");
  }
};

Samples randomSamples(int width, int height, int depth, int type) {
  std::mt19937 random(static_cast<unsigned>(100 * depth + type));
  Samples samples{width, height, depth, type, {}};
  for (int n = 0; n < width * height * channelsOf(type); ++n)
    samples.values.push_back(static_cast<unsigned>(random() >> (32 - depth)));
  return samples;
}

std::uint8_t toByte(unsigned value, int depth) {
  return static_cast<std::uint8_t>(std::lround(value * 255.0 / ((1 << depth) - 1)));
}

/// The part of the message of a refusal after the name. The message is one line.
std::string imageRefusal(const std::string& bytes) {
  try {
    parseImage(bytes, "a.png");
  } catch (const InputError& error) {
    const std::string message = error.what();
    REQUIRE(message.starts_with("a.png: "));
    return message.substr(7);
  }
  return "accepted";
}

struct Jpeg {
  J_COLOR_SPACE colors = JCS_RGB;
  int channels = 3;
  bool progressive = false;
  bool arithmetic = false;
  std::vector<jpeg_scan_info> scans = {};  ///< empty: those of the library
};

/// Grey value or colour of a smooth picture.
int gradient(int x, int y, int channel) {
  return channel == 0 ? 2 * x : channel == 1 ? 3 * y : 255 - x - y;
}

constexpr int kWide = 100;
constexpr int kHigh = 60;

std::string jpegOf(const Jpeg& kind, int width = kWide, int height = kHigh) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = kind.channels;
  jpeg.in_color_space = kind.colors;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg.arith_code = kind.arithmetic ? TRUE : FALSE;
  if (kind.progressive && kind.scans.empty()) jpeg_simple_progression(&jpeg);
  if (!kind.scans.empty()) {
    jpeg.scan_info = kind.scans.data();
    jpeg.num_scans = static_cast<int>(kind.scans.size());
  }
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < height; ++y) {
    std::vector<JSAMPLE> row;
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < kind.channels; ++c)
        row.push_back(static_cast<JSAMPLE>(gradient(x % kWide, y % kHigh, c)));
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string result(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return result;
}

}  // namespace

TEST_CASE("an image that was written is read back bit for bit", "[io][image][golden]") {
  const bool colour = GENERATE(false, true);
  const bool alpha = GENERATE(false, true);
  std::mt19937 random(1);
  Image image(13, 9);
  for (Pixel& pixel : image.pixels) {
    pixel.fill(static_cast<std::uint8_t>(random()));
    if (colour) pixel[1] = static_cast<std::uint8_t>(random());
    pixel[3] = alpha ? static_cast<std::uint8_t>(random()) : 255;
  }
  std::ostringstream stream;
  writePng(stream, image);
  const test::TemporaryFolder folder;
  const Image back = readImage(folder.write("with another extension.jpg", stream.str()));
  CHECK(back.width == image.width);
  CHECK(back.height == image.height);
  CHECK(back.pixels == image.pixels);
}

TEST_CASE("PNG of any depth and channels is read as 8-bit RGBA", "[io][image][property]") {
  const auto [type, depth] = GENERATE(table<int, int>({{kGrey, 1},
                                                       {kGrey, 2},
                                                       {kGrey, 4},
                                                       {kGrey, 8},
                                                       {kGrey, 16},
                                                       {kRgb, 8},
                                                       {kRgb, 16},
                                                       {kGreyAlpha, 8},
                                                       {kGreyAlpha, 16},
                                                       {kRgba, 8},
                                                       {kRgba, 16}}));
  const bool interlaced = GENERATE(false, true);
  const auto [width, height] = GENERATE(table<int, int>({{13, 11}, {1, 1}, {3, 9}, {64, 1}}));
  CAPTURE(type, depth, interlaced, width, height);
  const Samples samples = randomSamples(width, height, depth, type);
  const Image image = parseImage(samples.png(interlaced), "a.png");
  REQUIRE(image.width == width);
  REQUIRE(image.height == height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool grey = channelsOf(type) < 3;
      const bool alpha = channelsOf(type) % 2 == 0;
      Pixel expected{};
      for (int c = 0; c < 3; ++c)
        expected[static_cast<std::size_t>(c)] = toByte(samples.at(x, y, grey ? 0 : c), depth);
      expected[3] = alpha ? toByte(samples.at(x, y, channelsOf(type) - 1), depth) : 255;
      REQUIRE(image.at(x, y) == expected);
    }
}

TEST_CASE("a palette and its transparency are read", "[io][image][property]") {
  const int depth = GENERATE(1, 2, 4, 8);
  const bool interlaced = GENERATE(false, true);
  CAPTURE(depth, interlaced);
  const Samples samples = randomSamples(13, 11, depth, kPalette);
  const int colors = 1 << depth;
  std::mt19937 random(3);
  std::string palette;
  for (int n = 0; n < 3 * colors; ++n) palette += static_cast<char>(random());
  const std::string alphas = "\x10\x80"s;  // of the first two; the others are opaque
  const Image image =
      parseImage(samples.png(interlaced, chunk("PLTE", palette) + chunk("tRNS", alphas)), "a.png");
  for (int y = 0; y < samples.height; ++y)
    for (int x = 0; x < samples.width; ++x) {
      const std::size_t n = samples.at(x, y, 0);
      Pixel expected{};
      for (std::size_t c = 0; c < 3; ++c)
        expected[c] = static_cast<std::uint8_t>(palette[3 * n + c]);
      expected[3] = n < 2 ? static_cast<std::uint8_t>(alphas[n]) : 255;
      REQUIRE(image.at(x, y) == expected);
    }
}

TEST_CASE("the transparent colour of a PNG is compared at full depth", "[io][image][golden]") {
  const Samples grey{3, 1, 16, kGrey, {0x1234, 0x1235, 0xFFFF}};
  const Image image = parseImage(grey.png(false, chunk("tRNS", "\x12\x34"s)), "a.png");
  CHECK(image.pixels ==
        std::vector<Pixel>{{0x12, 0x12, 0x12, 0}, {0x12, 0x12, 0x12, 255}, {255, 255, 255, 255}});
  const Samples rgb{2, 1, 8, kRgb, {1, 2, 3, 1, 2, 4}};
  CHECK(parseImage(rgb.png(false, chunk("tRNS", "\0\1\0\2\0\3"s)), "a.png").pixels ==
        std::vector<Pixel>{{1, 2, 3, 0}, {1, 2, 4, 255}});
}

TEST_CASE("gamma and damaged texts of a PNG change no pixel", "[io][image][golden]") {
  const Samples samples = randomSamples(5, 5, 8, kRgb);
  const std::string text = chunk("tEXt", "a");
  const std::string others = chunk("gAMA", bigEndian(100000)) + text.substr(0, text.size() - 1) +
                             '?' + chunk("iCCP", "no profile");
  CHECK(parseImage(samples.png(false, others), "a.png").pixels ==
        parseImage(samples.png(false), "a.png").pixels);
}

TEST_CASE("JPEG is read within the errors of its compression", "[io][image][property]") {
  const bool grey = GENERATE(false, true);
  const bool progressive = GENERATE(false, true);
  CAPTURE(grey, progressive);
  const Image image = parseImage(
      jpegOf(grey ? Jpeg{JCS_GRAYSCALE, 1, progressive} : Jpeg{JCS_RGB, 3, progressive}), "a");
  REQUIRE(image.width == kWide);
  REQUIRE(image.height == kHigh);
  int largest = 0;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(image.at(x, y)[static_cast<std::size_t>(c)] -
                                             gradient(x, y, grey ? 0 : c)));
      REQUIRE(image.at(x, y)[3] == 255);
    }
  CHECK(largest <=
        6);  // steps of quantisation at quality 95 are up to 12, colours are halved in size
}

TEST_CASE("an image that is cut short anywhere is refused", "[io][image][error]") {
  const bool interlaced = GENERATE(false, true);
  const std::string png = randomSamples(9, 9, 8, kRgb).png(interlaced);
  for (std::size_t size = 0; size < png.size(); ++size) {
    CAPTURE(size);
    REQUIRE(imageRefusal(png.substr(0, size)) != "accepted");
  }
  const std::string jpeg = jpegOf({JCS_RGB, 3, interlaced}, 40, 30);
  for (std::size_t size = 0; size + 2 < jpeg.size(); ++size) {  // its last two bytes mark the end
    CAPTURE(size);
    REQUIRE(imageRefusal(jpeg.substr(0, size)) != "accepted");
  }
}

TEST_CASE("refusals of images say what is wrong and what to do", "[io][image][error]") {
  const std::string png = randomSamples(9, 9, 8, kRgb).png(false);
  std::string wrongSum = png;
  wrongSum[png.size() - 20] = static_cast<char>(wrongSum[png.size() - 20] ^ 1);
  const std::string jpeg = jpegOf({});
  const struct {
    std::string bytes;
    std::string message;
  } cases[] = {
      {"", "the file is empty"},
      {"mtllib a", "is neither PNG nor JPEG; convert the image to PNG"},
      {png.substr(0, 20), "the PNG is damaged: it does not start with a header; save it again"},
      {png.substr(0, 60), "the PNG is damaged: the file is cut short; save it again"},
      {wrongSum, "the PNG is damaged: "},
      {header(0, 5, 8, kRgb), "the image has 0 x 5 pixels; save it again"},
      {header(2147483648U, 2147483648U, 8, kRgb),
       "the image has 2147483648 x 2147483648 pixels, more than 2^28; scale it down"},
      {header(2147483648U, 1, 8, kRgb), "more than 2^28"},
      {header(10000, 10000, 8, kRgb),
       "the image is damaged: it claims 10000 x 10000 pixels, but the file has 33 bytes"},
      {header(9, 9, 7, kRgb), "the PNG is damaged: "},
      {jpeg.substr(0, jpeg.size() / 2),
       "the JPEG cannot be read: the file is cut short; save it again, or as PNG"},
      {jpegOf({JCS_CMYK, 4}), "the JPEG has CMYK colours; convert it to RGB"},
      {jpegOf({JCS_UNKNOWN, 2}), "the JPEG has 2 channels; convert it to RGB"},
      {jpegOf({JCS_RGB, 3, false, true}),
       "JPEG with arithmetic coding is not read; convert it to PNG"},
      {"\xFF\xD8\xFF"s, "the JPEG cannot be read: "},
      {"GIF89a...", "images in GIF format are not read; convert it to PNG"},
      {"RIFF\1\2\3\4WEBPVP8 ", "images in WebP format"},
      {"II*\0...."s, "images in TIFF format"},
      {"BM......", "images in BMP format"},
      {"\x76\x2F\x31\x01\2\0\0\0"s, "images in OpenEXR format"},
      {"8BPS\0\1"s, "images in Photoshop format"},
      {"\xABKTX 20\xBB\r\n", "images in KTX2 format"},
      {"\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0..."s, "images in TGA format"},
      {"...TRUEVISION-XFILE.\0"s, "images in TGA format"},
  };
  for (const auto& refused : cases) {
    CAPTURE(refused.message);
    CHECK_THAT(imageRefusal(refused.bytes),
               Catch::StartsWith(refused.message) || Catch::Contains(refused.message));
  }
}

TEST_CASE("a JPEG that claims more pixels than its bytes hold is refused", "[io][image][error]") {
  std::string jpeg = jpegOf({});
  const std::size_t frame = jpeg.find("\xFF\xC0"s);  // then its length, its depth, height and width
  REQUIRE(frame != jpeg.npos);
  const auto claim = [&](const std::string& sides) { return jpeg.replace(frame + 5, 4, sides); };
  CHECK_THAT(imageRefusal(claim("\xFF\xDC\xFF\xDC")),
             Catch::Contains("65500 pixels, more than 2^28"));
  CHECK_THAT(imageRefusal(claim("\xFF\xFF\xFF\xFF")),
             Catch::Contains("65500 pixels; save it again"));
  CHECK_THAT(imageRefusal(claim("\x20\0\x40\0"s)),
             Catch::Contains("it claims 16384 x 8192 pixels, but the file has"));
}

TEST_CASE("a JPEG of more scans than programs write is refused", "[io][image][error]") {
  std::vector<jpeg_scan_info> scans = {{1, {0}, 0, 0, 0, 0}};
  const int bits = GENERATE(1, 3);  // each of 63 coefficients comes bit by bit
  for (int bit = bits; bit >= 0; --bit)
    for (int n = 1; n < 64; ++n) scans.push_back({1, {0}, n, n, bit == bits ? 0 : bit + 1, bit});
  const std::string refused = imageRefusal(jpegOf({JCS_GRAYSCALE, 1, true, false, scans}));
  CHECK_THAT(refused,
             Catch::Contains(scans.size() > 200 ? "it has more than 200 scans" : "accepted"));
}

TEST_CASE("the least sizes of files that images claim are below those of real files",
          "[io][image][property]") {
  const int side = 2000;  // one colour: as small as files become
  const Samples black{side, side, 1, kGrey, std::vector<unsigned>(std::size_t{side} * side)};
  CHECK(parseImage(black.png(false), "a").pixels.size() == std::size_t{side} * side);
  const Samples wide{1 << 20, 1, 8, kRgba, std::vector<unsigned>(std::size_t{4} << 20U)};
  CHECK(parseImage(wide.png(false), "a").width == 1 << 20);
}

TEST_CASE("files that cannot be read as images are named", "[io][image][error]") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(readImage(folder / "none.png"),
                    Catch::EndsWith("none.png: no such file; check the path"));
  CHECK_THROWS_WITH(readImage(folder.path()), Catch::Contains("is a directory"));
  CHECK_THROWS_AS(readImage(folder.write("a.png", "GIF89a")), InputError);
}
