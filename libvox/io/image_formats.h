#pragma once

#include "libvox/core/image.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace vox {

/// The readers of each format; see read_image.h.
Image parsePng(std::string_view bytes, const std::string& name);
Image parseJpeg(std::string_view bytes, const std::string& name);

/// Size of an image, as the header of a file claims it.
struct ClaimedSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t leastBytes = 0;  ///< fewest bytes that a file of this size has
  std::uint64_t memory = 0;      ///< bytes that reading takes
};

/// @param fileSize  bytes of the file
/// @throws InputError  the image has no pixel, or more than kMaxPixels, or more than the file holds
/// @throws LimitError  the image does not fit into memory
void requireImageSize(const ClaimedSize& size, std::uint64_t fileSize, const std::string& name);

}  // namespace vox
