#pragma once

#include "libvox/voxelize/block_sink.h"
#include "libvox/voxelize/scan.h"

#include <cstdint>
#include <span>

namespace vox::detail {

// Triangles of any size, one at a time, as scan.h says.

/// @param triangle  its number, in blocks and messages
/// @throws LimitError  as scanTriangles
void scanLarge(std::span<const Vec3d, 3> corners, Index triangle, Separation separation,
               BlockSink& sink);

/// Parts of triangle 0, tiles of its rows, and the voxels of one of them.
std::int64_t largePartCount(std::span<const Vec3d, 3> corners);
void scanLargePart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
                   BlockSink& sink);

}  // namespace vox::detail
