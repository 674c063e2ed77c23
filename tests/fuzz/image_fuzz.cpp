// Fuzz target: any bytes are read as an image, or are refused with an error.

#include "libvox/io/read_image.h"
#include "tests/fuzz/laws.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vox;
  try {
    const Image image = parseImage({reinterpret_cast<const char*>(data), size}, VOX_FUZZ_FILE);
    fuzz::require(image.width > 0 && image.height > 0, "an image has a pixel");
    fuzz::require(image.pixels.size() == static_cast<std::size_t>(image.width) *
                                             static_cast<std::size_t>(image.height),
                  "an image has all its pixels");
    fuzz::require(image.pixels.size() <= kMaxPixels && image.pixels.size() <= 8 * 1032 * size,
                  "pixels are in proportion to bytes");
  } catch (const InputError& error) {
    fuzz::requireClearRefusal(error, VOX_FUZZ_FILE);
  }
  return 0;
}
