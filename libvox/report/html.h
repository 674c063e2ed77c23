#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vox {

/// Bytes as a data URI. Source: RFC 2397, RFC 4648.
/// @param type  such as image/png
std::string dataUri(std::string_view bytes, std::string_view type);
std::string base64(std::string_view bytes);

/// A number as people read it: 12,345,678.
std::string grouped(std::uint64_t number);
/// "1 voxel", "2,000 voxels".
std::string countOf(std::uint64_t number, const std::string& noun);
/// A number in at most six digits.
std::string shortNumber(double number);

}  // namespace vox
