#pragma once

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

/// What a grid will be like.
struct GridEstimate {
  GridKind kind;
  double voxels = 0;     ///< active
  double leaves = 0;     ///< nodes of 8^3 voxels
  double bytes = 0;      ///< in memory
  double peakBytes = 0;  ///< while it is made
  double fileBytes = 0;
};

/// What a conversion will make, before it is made. Numbers are within a factor of 1.5 of the truth
/// for smooth objects that do not overlap, of some tens of voxels and more; files of
/// textures depend on the pattern and may be a third.
struct Estimate {
  double voxelSize = 0;  ///< world units
  int levels = 0;        ///< as levelsOf
  double voxels = 0;     ///< black; 0 if none are needed
  std::vector<GridEstimate> grids;
  double bytes = 0;       ///< of all grids at their peak, voxels included
  double fixedBytes = 0;  ///< of them, what does not become less with larger voxels
  double fileBytes = 0;
  bool certain = true;  ///< false: a surface may shrink from its boundary to far less
  std::string refusal;  ///< why it would be refused; empty if it would not
};

/// An estimate is refused if it is more than so many times what is left: within that it may fit.
inline constexpr double kEstimateFactor = 1.5;

/// Estimates from few polygons near each surface: their area, by direction, and the places of large
/// nodes that they meet. Cheap beside the conversion.
/// @param surfaces  in index space
Estimate estimateGrids(std::span<const PreparedSurface> surfaces, std::span<const GridKind> kinds,
                       const VolumeSettings& volume);

/// Doo-Sabin steps down to the deepest vertex, about.
int levelsOf(const PreparedSurface& surface, const SurfaceOptions& options,
             const Progress& progress);

/// Why what is estimated cannot fit, with a resolution that does; empty if it may.
/// @param longestSide  of the input, world units
std::string refusalOf(const Estimate& estimate, double longestSide, const MemoryBudget& budget);

}  // namespace vox
