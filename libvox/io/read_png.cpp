// PNG by libpng, every kind as 8-bit RGBA.
//
// libpng reports errors with longjmp. A function that calls setjmp therefore has no object with a
// destructor, and changes no variable of its own that it reads after a jump.

#include "libvox/core/error.h"
#include "libvox/io/image_formats.h"

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <png.h>

namespace vox {

namespace {

class PngReader {
 public:
  PngReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  Image read() {
    requireImageSize(claimedSize(), bytes_.size(), name_);
    if (!readHeader()) refuse();
    Image image(static_cast<int>(png_get_image_width(png_, info_)),
                static_cast<int>(png_get_image_height(png_, info_)));
    if (!readRows(image)) refuse();
    return image;
  }

 private:
  ClaimedSize claimedSize() const;
  bool readHeader();
  bool readRows(Image& image);
  [[noreturn]] void refuse() const {
    throw InputError(name_ + ": the PNG is damaged: " + message_ + "; save it again");
  }

  static void take(png_structp png, png_bytep target, std::size_t count);
  static void fail(png_structp png, png_const_charp message);
  static void ignore(png_structp, png_const_charp) {}

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;  // of an interlaced image 7
  char message_[128] = "";
};

/// The size in the first chunk. Deflate makes at most 1032 bytes of one.
ClaimedSize PngReader::claimedSize() const {
  constexpr std::size_t kHeader = 29;  // bytes up to the checksum of the first chunk
  constexpr std::uint64_t kMostExpansion = 1032;
  constexpr std::uint64_t kMostSide = 0x7fffffff;
  if (bytes_.size() < kHeader || bytes_.substr(12, 4) != "IHDR")
    throw InputError(name_ +
                     ": the PNG is damaged: it does not start with a header; save it again");
  const auto byte = [&](std::size_t at) {
    return std::uint64_t{static_cast<std::uint8_t>(bytes_[at])};
  };
  const auto number = [&](std::size_t at) {
    return byte(at) << 24U | byte(at + 1) << 16U | byte(at + 2) << 8U | byte(at + 3);
  };
  ClaimedSize size{.width = number(16), .height = number(20)};
  const std::uint64_t channels = (byte(25) & 2U) != 0 && (byte(25) & 1U) == 0 ? 3 : 1;
  const std::uint64_t bitsPerPixel = byte(24) * channels;  // at least
  if (size.width <= kMostSide && size.height <= kMostSide)
    size.leastBytes = size.height * ((size.width * bitsPerPixel + 7) / 8) / kMostExpansion;
  constexpr std::uint64_t kRowBuffers = 2 * 8;  // libpng's two rows of at most 4 x 16 bits
  size.memory = size.width * (size.height * sizeof(Pixel) + kRowBuffers);
  return size;
}

bool PngReader::readHeader() {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  png_set_read_fn(png_, this, take);
  png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);  // requireImageSize has the limits
  png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // pixels only
  png_read_info(png_, info_);
  png_set_expand(png_);
  png_set_scale_16(png_);
  png_set_gray_to_rgb(png_);
  png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
  passes_ = png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  return true;
}

bool PngReader::readRows(Image& image) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  for (int pass = 0; pass < passes_; ++pass)
    for (int y = 0; y < image.height; ++y) png_read_row(png_, image.at(0, y).data(), nullptr);
  png_read_end(png_, nullptr);
  return true;
}

void PngReader::take(png_structp png, png_bytep target, std::size_t count) {
  auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader.bytes_.size() - reader.at_) png_error(png, "the file is cut short");
  std::memcpy(target, reader.bytes_.data() + reader.at_, count);
  reader.at_ += count;
}

void PngReader::fail(png_structp png, png_const_charp message) {
  auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
  std::snprintf(reader.message_, sizeof reader.message_, "%s", message);
  png_longjmp(png, 1);
}

}  // namespace

Image parsePng(std::string_view bytes, const std::string& name) {
  return PngReader(bytes, name).read();
}

}  // namespace vox
