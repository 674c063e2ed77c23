// Tells formats of images apart by their first bytes.

#include "libvox/io/read_image.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/io/image_formats.h"
#include "libvox/io/input_file.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace vox {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpeg = "\xFF\xD8\xFF"sv;

/// Bytes that tell a format that is not read.
struct Sign {
  std::size_t at;
  std::string_view bytes;
  const char* format;
};

constexpr Sign kOtherFormats[] = {
    {0, "GIF8"sv, "GIF"},
    {8, "WEBP"sv, "WebP"},
    {0, "II*\0"sv, "TIFF"},
    {0, "MM\0*"sv, "TIFF"},
    {0, "BM"sv, "BMP"},
    {0, "\x76\x2F\x31\x01"sv, "OpenEXR"},
    {0, "8BPS"sv, "Photoshop"},
    {0, "\xABKTX 20\xBB"sv, "KTX2"},
    {0, "\xABKTX 11\xBB"sv, "KTX"},
    {0, "DDS "sv, "DDS"},
    {0, "#?R"sv, "Radiance HDR"},
    {4, "jP  "sv, "JPEG 2000"},
    {0, "\xFF\x4F\xFF\x51"sv, "JPEG 2000"},
    {4, "JXL "sv, "JPEG XL"},
    {0, "\xFF\x0A"sv, "JPEG XL"},
    {4, "ftypavif"sv, "AVIF"},
    {4, "ftyphei"sv, "HEIF"},
    {4, "ftypmif1"sv, "HEIF"},
    {0, "<svg"sv, "SVG"},
    {0, "<?xml"sv, "SVG"},
};

/// TGA has no sign at its start: its header has kinds and depths of pixels, and many files end with
/// a sign.
bool isTga(std::string_view bytes) {
  constexpr std::size_t kHeader = 18;
  if (bytes.ends_with("TRUEVISION-XFILE.\0"sv)) return true;
  if (bytes.size() < kHeader) return false;
  const auto oneOf = [&](std::size_t at, std::string_view values) {
    return values.find(bytes[at]) != values.npos;
  };
  return oneOf(1, "\0\1"sv) && oneOf(2, "\1\2\3\11\12\13"sv) && oneOf(16, "\10\17\20\30\40"sv);
}

/// Name of a known format that is not read; empty: the format is unknown.
std::string_view otherFormat(std::string_view bytes) {
  const auto* const found =
      std::find_if(std::begin(kOtherFormats), std::end(kOtherFormats), [&](const Sign& sign) {
        return bytes.size() >= sign.at && bytes.substr(sign.at).starts_with(sign.bytes);
      });
  if (found != std::end(kOtherFormats)) return found->format;
  return isTga(bytes) ? "TGA" : "";
}

}  // namespace

void requireImageSize(const ClaimedSize& size, std::uint64_t fileSize, const std::string& name) {
  const std::string sides = std::to_string(size.width) + " x " + std::to_string(size.height);
  if (size.width == 0 || size.height == 0)
    throw InputError(name + ": the image has " + sides + " pixels; save it again");
  if (size.width > kMaxPixels / size.height)
    throw InputError(name + ": the image has " + sides + " pixels, more than 2^28; scale it down");
  if (size.leastBytes > fileSize)
    throw InputError(name + ": the image is damaged: it claims " + sides +
                     " pixels, but the file has " + std::to_string(fileSize) +
                     " bytes; save it again");
  if (size.memory > availableMemory())
    throw LimitError(name + ": an image of " + sides + " pixels needs " + formatBytes(size.memory) +
                     " of memory; scale it down");
}

Image parseImage(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(name + ": the file is empty");
  if (bytes.starts_with(kPng)) return parsePng(bytes, name);
  if (bytes.starts_with(kJpeg)) return parseJpeg(bytes, name);
  const std::string_view format = otherFormat(bytes);
  if (!format.empty())
    throw InputError(name + ": images in " + std::string(format) +
                     " format are not read; convert it to PNG");
  throw InputError(name + ": is neither PNG nor JPEG; convert the image to PNG");
}

Image readImage(const std::filesystem::path& file) {
  return parseImage(contentsOf(file), file.string());
}

}  // namespace vox
