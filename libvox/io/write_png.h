#pragma once

#include "libvox/core/image.h"

#include <iosfwd>

namespace vox {

/// Writes a PNG in the smallest lossless form: grey or colour, with or without coverage, 8 bits
/// each. Equal images give equal bytes.
/// @throws IoError  the stream fails
void writePng(std::ostream& stream, const Image& image);

}  // namespace vox
