#pragma once

#include "libvox/core/unit_root.h"
#include "libvox/mesh/flat_polygon.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace vox {

/// A corner where a region bends inward.
struct Bend {
  Eigen::Vector2d outward = Eigen::Vector2d::Zero();  ///< unit vector out of the region
  double size = 0;                                    ///< the shorter side there; 0: no bend
};

/// The bends of a region: one for each corner.
/// @param loops  its outline, counter-clockwise, and holes, clockwise
std::vector<Bend> bendsOf(std::span<const FlatPoint> flat,
                          std::span<const std::vector<Index>> loops);

/// Measures how far a part of a region would let the smooth surface out of the region.
class BulgeMeter {
 public:
  /// How far the images (DESIGN section 6) of the part's corners at bends lie on the outward side
  /// of these, at most, in multiples of the size of the bend; 0 for none.
  /// @param part  its corners, counter-clockwise
  double of(std::span<const Index> part, std::span<const FlatPoint> flat,
            std::span<const Bend> bends);

 private:
  std::vector<std::vector<UnitRoot>> roots_;  ///< by number of corners
};

}  // namespace vox
