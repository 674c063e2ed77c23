#pragma once

#include "libvox/core/image.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace vox {

/// Most pixels of an image that is read: 1 GiB of them.
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28U;

/// Reads an image: PNG of any kind (16 bits are rounded to 8), or JPEG in grey or colour. The
/// content tells the format, not the extension. Colours are taken as sRGB: colour profiles, gamma
/// values and the orientation of photographs are not used, as glTF asks for textures.
///
/// The memory is in proportion to the size of the file: a header that claims more pixels than so
/// many bytes can hold is refused before any are allocated.
///
/// @return  at least one pixel; coverage 255 where the file has none
/// @throws InputError  "FILE: ...": the file is missing, damaged or cut short, has more than
///   kMaxPixels pixels, colours other than grey and RGB, or another format
/// @throws LimitError  the image does not fit into memory
Image readImage(const std::filesystem::path& file);

/// Reads an image from the content of a file.
/// @param name  of the file, for messages
/// @throws InputError, LimitError  as readImage
Image parseImage(std::string_view bytes, const std::string& name);

}  // namespace vox
