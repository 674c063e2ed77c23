#pragma once

#include "libvox/grid/openvdb.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// How many values lie in each of some intervals of equal width; of equal ratio if the values range
/// over more than a factor of 50.
struct Histogram {
  std::vector<double> bounds;         ///< one more than counts
  std::vector<std::uint64_t> counts;  ///< values within [bounds[i], bounds[i + 1]); the last: <=
  std::uint64_t notFinite = 0;
};

/// Of the positive active values.
Histogram histogramOf(const openvdb::FloatTree& values);

/// As bars, with a text for those who do not see them. Empty if there are no values.
std::string histogramFigure(const Histogram& histogram);

}  // namespace vox
