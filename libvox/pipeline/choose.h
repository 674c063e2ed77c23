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

/// Polygons are tried where there would be more vertices per voxel than the first number, and taken
/// where these would be more than the second number of times those of the polygons. A vertex that
/// blackens a voxel costs 1 to 3 ns, one that is a corner of scanned triangles 300 and more. As
/// measured (2 threads): a needle of 1000:1 at 20000 voxels 0.7 s by polygons, 2.3 s by
/// vertices; a cone of 50 faces at 1024 voxels (48 times as many vertices) 1.2 s and 0.5 s.
inline constexpr double kMostVerticesPerVoxel = 64;
inline constexpr double kVerticesPerPolygonVertex = 256;

/// What is wrong with a combination, for messages; empty if nothing.
std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation);

/// The way for an object of a prepared mesh in index space.
///
/// Stop rules with limits mean polygons, refined to them. Until voxel: vertices by default;
/// kPolygon: polygons whose faces fit into voxels; and with kAuto polygons of kAutomaticFlatness
/// where vertices cannot do it (26-separating), or would be far too many. These are scanned
/// 26-separating: that has about the voxels that vertices would blacken, and nothing thin gets
/// lost. Vertices are counted, patch by patch, only for meshes that look like slivers: whose long
/// faces have little area.
/// @throws LimitError, Cancelled
ConversionWay chooseWay(const SubdivisionLevel& base, const StopRule& until, Voxelize voxelize,
                        Separation separation, const SurfaceOptions& options,
                        const Progress& progress);

}  // namespace vox
