#pragma once

#include "libvox/io/read_report.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace vox {

inline constexpr std::size_t kStlHeaderBytes = 84;  ///< 80 of comment, 4 of triangle count
inline constexpr std::size_t kFacetBytes = 50;      ///< normal, 3 positions, 2 of attribute

/// The triangle count in a header.
std::uint64_t binaryTriangleCount(std::string_view data);

/// Whether the content has the size that a binary header gives, or more.
bool isBinaryStl(std::string_view data);

/// Reads a binary file. Equal positions become one point; points are numbered in order of
/// appearance. Parallel; the result is the same for any number of facets per block, at least 1.
/// Precondition: isBinaryStl
PolygonMesh parseBinaryStl(std::string_view data, std::uint64_t facetsPerBlock, ReadReport& report);

}  // namespace vox
