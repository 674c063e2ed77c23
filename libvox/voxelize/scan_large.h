#pragma once

#include "libvox/voxelize/block_sink.h"
#include "libvox/voxelize/scan.h"

#include <cstdint>
#include <span>

namespace vox::detail {

// Scan of triangles of any size, one at a time; results as in scan.h.

/// Scans one triangle.
/// @param triangle  its number in blocks and messages
/// @throws LimitError  as scanTriangles
void scanLarge(std::span<const Vec3d, 3> corners, Index triangle, Separation separation,
               BlockSink& sink);

/// Number of parts of a triangle, and scan of one part (scanPartCount, scanTrianglePart).
std::int64_t largePartCount(std::span<const Vec3d, 3> corners);
void scanLargePart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
                   BlockSink& sink);

}  // namespace vox::detail
