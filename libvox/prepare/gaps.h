#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/prepare/repair.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace vox {

/// How far apart the two sides of an opening of a mesh are.
struct Gap {
  double width = 0;  ///< units of the points
  Vec3d at = Vec3d::Zero();
};

/// The gaps of an open mesh, and what closes them.
struct GapReport {
  std::size_t count = 0;  ///< boundary loops
  Gap widest, narrowest;  ///< of the loops
  /// A tolerance that leaves fewer boundary loops, tried out; nothing if none was found.
  std::optional<double> weld;
  std::size_t closes = 0;  ///< the number of loops that it closes
};

/// Measures the boundary loops of a mesh once it is repaired with these options.
///
/// A seam is a loop whose vertices lie near edges of another loop, or of a far part of their own:
/// so far along the loop that the way there is more than twice the distance. Its width is the
/// largest of these distances, each to the nearest such edge. Any other loop is a hole; its width
/// is the middle one of the three extents of its box.
///
/// Then tolerances a little above the widths of seams are tried: the whole mesh is repaired with
/// each, for at most 4 of them.
/// @throws as repair
GapReport measureGaps(const PolygonMesh& mesh, const RepairOptions& options);

/// "3 gaps, the widest 0.02 at (1, 0, 0); --weld 0.021 closes all", or "... closes 2 of them";
/// empty without gaps.
std::string summary(const GapReport& report);

/// A number in the fewest digits that read back as the same float, of at least 6 digits: 500000.25.
std::string exactNumber(double x);
/// "(1, 0, 0.5)".
std::string exactPoint(const Vec3d& p);

}  // namespace vox
