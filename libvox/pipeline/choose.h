#pragma once

#include "libvox/options/stop_rule.h"
#include "libvox/voxelize/scan.h"

#include <string>

namespace vox {

/// How an object becomes voxels.
struct ConversionWay {
  bool polygons = false;
  StopRule until = {};  ///< of the polygons
  Separation separation = Separation::k6;
};

/// Distance between polygons and smooth surface where polygons stand in for vertices, in voxels.
/// Together with the half voxel of the scan it stays well within vertex conversion's own distance
/// of a voxel.
inline constexpr double kAutomaticFlatness = 0.1;

/// What is wrong with a combination, for messages; empty if nothing.
std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation);

/// The way for an object. Stop rules with limits mean polygons, refined to them. Until voxel:
/// vertices; with kPolygon polygons whose faces fit into voxels; and with kAuto, where vertices
/// cannot do it (26-separating), polygons of kAutomaticFlatness.
ConversionWay chooseWay(const StopRule& until, Voxelize voxelize, Separation separation);

}  // namespace vox
