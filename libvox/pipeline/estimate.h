#pragma once

#include "libvox/grid/pages.h"
#include "libvox/grid/region.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/surface_options.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"

#include <span>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// Expected size of a grid.
struct GridEstimate {
  GridKind kind;
  double voxels = 0;     ///< active
  double leaves = 0;     ///< nodes of 8^3 voxels
  double bytes = 0;      ///< in memory
  double peakBytes = 0;  ///< while it is made
  double fileBytes = 0;
};

/// Expected result of a conversion. The numbers are within a factor of 1.5 of the truth for smooth
/// objects that do not overlap and are some tens of voxels long or more. The file of a texture
/// depends on the pattern and may be a third of the estimate.
struct Estimate {
  double voxelSize = 0;  ///< world units
  int levels = 0;        ///< levelsOf the deepest object
  double voxels = 0;     ///< active voxels of the surfaces; 0 if no grid needs them
  std::vector<GridEstimate> grids;
  double bytes = 0;       ///< of all grids at their peak, and of the voxels of the surfaces
  double fixedBytes = 0;  ///< the part of `bytes` that larger voxels do not reduce
  double wholeBytes = 0;  ///< the part of `bytes` that each part of a run needs
  std::vector<PageShare> shares = {};  ///< of all parts, if it is a part of a run
  double fileBytes = 0;
  bool certain = true;  ///< false: a surface may shrink from its boundary to a far smaller one
  std::string refusal;  ///< why the conversion would be refused; empty if it would not
};

/// A conversion is refused if the estimate is more than this many times the memory that is left. A
/// smaller one may fit.
inline constexpr double kEstimateFactor = 1.5;

/// Estimates grids from few polygons near each surface: from their area, by direction, and from the
/// large nodes that they meet. Costs little compared with the conversion. Sets neither voxel size
/// nor levels.
/// @param region  the voxels asked for
/// @param share   if the region has pages: part of the cost that they have
/// @param cutsLevelSets  as in cut.h
Estimate estimateGrids(std::span<const PreparedSurface> surfaces, std::span<const GridKind> kinds,
                       const VolumeSettings& volume, const Region& region = {}, double share = 1,
                       bool cutsLevelSets = false);

/// Approximate number of Doo-Sabin steps down to the deepest vertex.
int levelsOf(const PreparedSurface& surface, Progress& progress);

/// Why the grids cannot fit into memory, and a resolution at which they do; empty if they may fit.
/// @param longestSide  of the input, world units
std::string refusalOf(const Estimate& estimate, double longestSide, const MemoryBudget& budget);

}  // namespace vox
