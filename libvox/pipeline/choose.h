#pragma once

#include "libvox/core/progress.h"
#include "libvox/mesh/stop_rule.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/level.h"
#include "libvox/voxelize/scan.h"

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

/// More vertices per voxel than that, and polygons are faster. Vertices cost some 2 ns, a scanned
/// voxel with its share of refining about 100 (README, "What is in the box").
inline constexpr double kMostVerticesPerVoxel = 64;

/// What is wrong with a combination, for messages; empty if nothing.
std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation);

/// The way for an object of a prepared mesh in index space.
///
/// Stop rules with limits mean polygons, refined to them. Until voxel: vertices by default;
/// kPolygon: polygons whose faces fit into voxels; and with kAuto polygons of kAutomaticFlatness
/// where vertices cannot do it (26-separating) or would be more than kMostVerticesPerVoxel: scanned
/// 26-separating, since that has about the voxels that vertices would blacken, and nothing thin
/// gets lost. How
/// many they would be is counted, patch by patch, only for meshes that look like it: whose long
/// faces have little area.
/// @throws LimitError, Cancelled
ConversionWay chooseWay(const SubdivisionLevel& base, const StopRule& until, Voxelize voxelize,
                        Separation separation, const SurfaceOptions& options,
                        const Progress& progress);

}  // namespace vox
