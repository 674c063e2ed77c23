#pragma once

#include "libvox/options/stop_rule.h"
#include "libvox/options/voxelize.h"

#include <optional>
#include <string>

namespace vox {

/// How an object becomes voxels.
struct ConversionWay {
  bool polygons = false;  ///< true: polygons are scanned; false: vertices are rounded
  StopRule until = {};    ///< where the refinement of the polygons stops
  Separation separation = Separation::k6;
};

/// Distance between polygons and smooth surface where polygons replace vertices, in voxels.
/// Together with the half voxel of the scan it stays well within vertex conversion's own distance
/// of a voxel.
inline constexpr double kAutomaticFlatness = 0.1;

/// What is wrong with a combination, for messages; empty if it is possible.
std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation);

/// The way for an object. A stop rule with limits means polygons that are refined to these limits.
/// Until voxel means vertices, with two exceptions: kPolygon means polygons whose faces fit into
/// voxels; kAuto with 26-separation, which vertices cannot give, means polygons of
/// kAutomaticFlatness.
ConversionWay chooseWay(const StopRule& until, Voxelize voxelize, Separation separation);

/// The level at which all faces of an object stop; empty if they stop at different levels.
inline std::optional<int> levelOf(const ConversionWay& way) {
  const bool ofLevel = way.polygons && way.until == StopRule{way.until.levels};
  return ofLevel ? way.until.levels : std::nullopt;
}

}  // namespace vox
