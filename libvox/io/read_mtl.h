#pragma once

#include "libvox/mesh/material.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace vox {

/// Reads the materials of an MTL file, the companion of OBJ, in the order of their names in the
/// file. A name that comes again goes on with its material.
///
/// Read are newmtl, Kd, d, Tr (1 - d) and map_Kd with -s, -o and -clamp; other statements and
/// options are skipped. Words may be in any case. Numbers outside 0 to 1 are brought into it.
///
/// The format does not say whether Kd is linear or sRGB, and programs differ. It is linear here, as
/// in Blender, which writes and reads it so. Images are sRGB. Where there is an image, Kd is not a
/// factor of it, as in Blender: many programs write Kd 0 beside an image.
///
/// Images are relative to the folder of the MTL file. Backslashes in their paths become slashes. An
/// absolute path of Windows becomes its file name. An image that is missing at its path, but is
/// there beside the MTL file, is taken from there.
///
/// @throws InputError  the file is missing or unreadable, or a number is malformed ("FILE:LINE: ")
/// @throws LimitError  the file is larger than the available memory
/// Source: Wavefront MTL material format (MTL_spec), version 4.2, October 1995.
std::vector<Material> readMtl(const std::filesystem::path& file);

/// Reads materials from the content of a file, without a look at the images.
/// @param file  is named in messages; its folder is that of the images
/// @throws InputError  as readMtl
std::vector<Material> parseMtl(std::string_view text, const std::filesystem::path& file);

/// The name in what follows newmtl, usemtl or map_Kd on a line. Names may have blanks inside. A #
/// begins a comment only after a blank. Quotes around the name are dropped.
std::string_view materialName(std::string_view restOfLine);

}  // namespace vox
