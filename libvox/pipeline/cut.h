#pragma once

#include "libvox/grid/pages.h"
#include "libvox/grid/region.h"
#include "libvox/options/run_part.h"
#include "libvox/pipeline/prepared_surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Pages that surfaces meet, in the order of files, and the area of the surfaces in each, in units
/// that add up without rounding.
struct PageCosts {
  std::vector<openvdb::Coord> pages;
  std::vector<std::uint64_t> costs;
};

/// The costs of the pages that hold voxels of a region. From few polygons near the surfaces
/// (few_polygons.h); so the same on every machine, for any number of threads.
PageCosts costsOf(std::span<const PreparedSurface> surfaces, const Region& region);

/// Whether a level set of a part is made of its pages alone. Small ones are made whole, and
/// cropped: then surfaces may meet themselves.
bool cutsLevelSets(std::span<const PageShare> shares);

/// Cuts all pages there are into contiguous ranges of about equal cost.
std::vector<PageShare> cutInto(int count, const PageCosts& costs);

}  // namespace vox
