#pragma once

#include "libvox/grid/leaf_cache.h"
#include "libvox/mesh/patch.h"

#include <cstdint>

namespace vox {

/// Computes successive vertices among the n = 2^k vertices of a curve, or of a row of a patch, on
/// the vector unit. Products and sums of doubles have a fixed order, so the bits are the same on
/// every processor.
/// @param first  number of the first vertex
/// @param count  number of vertices, at most LeafCache::kPositionsAtOnce
void setRow(const CurvePoints& points, std::int64_t n, std::int64_t first, std::size_t count,
            LeafCache::Positions& positions);

}  // namespace vox
