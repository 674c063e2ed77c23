// JPEG by libjpeg-turbo, as 8-bit RGBA.
//
// Like libpng, the library reports errors with longjmp: see read_png.cpp. It only warns of damaged
// data and goes on with grey pixels; such warnings are errors here.

#include "libvox/core/error.h"
#include "libvox/io/image_formats.h"

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <jerror.h>
#include <jpeglib.h>

namespace vox {

namespace {

constexpr int kMostScans = 200;  // of a progressive image; each may take time for no bytes

class JpegReader {
 public:
  JpegReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = fail;
    errors_.emit_message = warn;
    errors_.output_message = [](j_common_ptr) {};
    jpeg_.client_data = this;
    progress_.progress_monitor = countScans;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  Image read() {
    if (!readHeader()) refuse();
    requireKind();
    requireImageSize(claimedSize(), bytes_.size(), name_);
    Image image(static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height));
    if (!readRows(image.pixels.data())) refuse();
    return image;
  }

 private:
  bool readHeader();
  void requireKind() const;
  ClaimedSize claimedSize() const;
  bool readRows(Pixel* pixels);
  [[noreturn]] void refuse() const {
    throw InputError(name_ + ": the JPEG cannot be read: " + message_ +
                     "; save it again, or as PNG");
  }

  [[noreturn]] void jump(const char* message) {
    std::snprintf(message_, sizeof message_, "%s", message);
    std::longjmp(jump_, 1);
  }
  static JpegReader& of(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }
  static void fail(j_common_ptr jpeg);
  static void warn(j_common_ptr jpeg, int level);
  static void countScans(j_common_ptr jpeg);

  std::string_view bytes_;
  const std::string& name_;
  jpeg_decompress_struct jpeg_{};
  jpeg_error_mgr errors_{};
  jpeg_progress_mgr progress_{};
  std::jmp_buf jump_{};
  char message_[JMSG_LENGTH_MAX] = "";
};

bool JpegReader::readHeader() {
  if (setjmp(jump_) != 0) return false;
  jpeg_create_decompress(&jpeg_);
  jpeg_.progress = &progress_;
  jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
  jpeg_read_header(&jpeg_, TRUE);
  return true;
}

void JpegReader::requireKind() const {
  const J_COLOR_SPACE space = jpeg_.jpeg_color_space;
  if (space == JCS_CMYK || space == JCS_YCCK)
    throw InputError(name_ + ": the JPEG has CMYK colours; convert it to RGB");
  if (space == JCS_UNKNOWN)
    throw InputError(name_ + ": the JPEG has " + std::to_string(jpeg_.num_components) +
                     " channels; convert it to RGB");
  if (jpeg_.arith_code != FALSE)
    throw InputError(name_ + ": JPEG with arithmetic coding is not read; convert it to PNG");
}

/// A block of 8 x 8 pixels takes at least one bit. Several scans keep their coefficients.
ClaimedSize JpegReader::claimedSize() const {
  constexpr std::uint64_t kMostPixelsPerByte = 8 * 8 * 8;
  ClaimedSize size{.width = jpeg_.image_width, .height = jpeg_.image_height};
  size.leastBytes = size.width * size.height / kMostPixelsPerByte;
  const auto channels = static_cast<std::uint64_t>(jpeg_.num_components);
  size.memory = size.width * size.height * (sizeof(Pixel) + sizeof(JCOEF) * channels);
  return size;
}

bool JpegReader::readRows(Pixel* pixels) {
  if (setjmp(jump_) != 0) return false;
  jpeg_.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg_);
  while (jpeg_.output_scanline < jpeg_.output_height) {
    JSAMPROW row = pixels[std::size_t{jpeg_.output_scanline} * jpeg_.output_width].data();
    jpeg_read_scanlines(&jpeg_, &row, 1);
  }
  return true;
}

void JpegReader::fail(j_common_ptr jpeg) {
  char message[JMSG_LENGTH_MAX];
  jpeg->err->format_message(jpeg, message);
  of(jpeg).jump(message);
}

/// Level -1 is a warning. Those of pixels that are missing or wrong are errors.
void JpegReader::warn(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  switch (jpeg->err->msg_code) {
    case JWRN_JPEG_EOF:
      of(jpeg).jump("the file is cut short");
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_BOGUS_PROGRESSION:
      fail(jpeg);
      break;
    default:
      break;
  }
}

void JpegReader::countScans(j_common_ptr jpeg) {
  if (of(jpeg).jpeg_.input_scan_number > kMostScans) of(jpeg).jump("it has more than 200 scans");
}

}  // namespace

Image parseJpeg(std::string_view bytes, const std::string& name) {
  return JpegReader(bytes, name).read();
}

}  // namespace vox
