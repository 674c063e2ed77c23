#pragma once

#include "libvox/io/ply_blocks.h"
#include "libvox/mesh/polygon_mesh.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace vox {

/// Numbers of points, corners and faces.
struct PlyCounts {
  std::size_t points = 0, corners = 0, faces = 0;
};

/// Binary elements of one kind that are only positions, or only faces, of one type of numbers. They
/// can be written straight to their places in a mesh, since their counts are known.
struct PlainBlock {
  const PlyElement* element;
  PlyType type;
  std::uint64_t count;
  std::string_view bytes;
  std::endian order;
};

/// The block as a plain one; nothing: it is a text, of another kind, or has more, such as colours.
std::optional<PlainBlock> plainBlockOf(const PlyHeader& header, const PlyBlock& block);

PlyCounts countsOf(const PlainBlock& block);

/// Writes the points or faces of a block to a mesh that has room for them.
/// @param start  number of the first
/// @return       false: a coordinate is too large, an index is out of range, or a face is too short
bool loadPlain(const PlainBlock& block, std::uint64_t vertexCount, const PlyCounts& start,
               PolygonMesh& mesh);

}  // namespace vox
