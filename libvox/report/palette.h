#pragma once

#include "libvox/core/image.h"
#include "libvox/grid/openvdb.h"

#include <string>

namespace vox {

// Colours of differences, in pictures, legend and viewer (sRGB).
inline constexpr Pixel kOnlyAColor = {226, 54, 42, 255};     // red
inline constexpr Pixel kOnlyBColor = {38, 106, 222, 255};    // blue
inline constexpr Pixel kSmallColor = {246, 226, 75, 255};    // yellow: the smallest difference
inline constexpr Pixel kLargeColor = {16, 112, 52, 255};     // green: the largest
inline constexpr Pixel kCommonColor = {176, 176, 176, 255};  // grey

/// The colour of a difference of values.
/// @param part  of the largest difference, 0 .. 1
Pixel valueColor(double part);

/// As pictures are lit.
openvdb::Vec3f linearColor(const Pixel& color);

/// For style sheets: "#e2362a".
std::string cssColor(const Pixel& color);

}  // namespace vox
