#pragma once

#include "libvox/grid/bricks.h"
#include "libvox/grid/region.h"
#include "libvox/options/run_part.h"
#include "libvox/pipeline/prepared_surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Bricks that surfaces meet, in the order of files, and the area of the surfaces in each, in units
/// that add up without rounding.
struct BrickCosts {
  std::vector<openvdb::Coord> bricks;
  std::vector<std::uint64_t> costs;
};

/// The costs of the bricks that hold voxels of a region. From few polygons near the surfaces
/// (few_polygons.h); so the same on every machine, for any number of threads.
BrickCosts costsOf(std::span<const PreparedSurface> surfaces, const Region& region);

/// A part of the bricks.
struct BrickShare {
  BrickRange range;
  std::size_t bricks = 0;  ///< that surfaces meet
  double cost = 0;         ///< part of the cost of all
};

/// Cuts all bricks there are into contiguous ranges of about equal cost.
std::vector<BrickShare> cutInto(int count, const BrickCosts& costs);

}  // namespace vox
