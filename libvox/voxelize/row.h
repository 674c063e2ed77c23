#pragma once

#include "libvox/grid/leaf_cache.h"
#include "libvox/mesh/patch.h"

#include <cstdint>

namespace vox {

/// Some neighbours among the n = 2^k vertices of a curve or of a row of a patch, evaluated on the
/// vector unit: the same bits on every processor, products and sums of doubles in a fixed order.
/// @param first  number of the first of them
/// @param count  how many, up to LeafCache::kPositionsAtOnce
void setRow(const CurvePoints& points, std::int64_t n, std::int64_t first, std::size_t count,
            LeafCache::Positions& positions);

}  // namespace vox
