// Vertices or polygons.

#include "libvox/pipeline/choose.h"

#include "libvox/options/voxelize.h"

namespace vox {

std::string faultOf(const StopRule& until, Voxelize voxelize, Separation separation) {
  if (const std::string fault = faultOf(until); !fault.empty()) return fault;
  if (voxelize != Voxelize::kVertex) return {};
  if (!until.untilVoxel())
    return "--voxelize vertex needs --until voxel, not " + stopRuleName(until) +
           "; use --voxelize auto or polygon";
  if (separation == Separation::k26)
    return "--voxelize vertex cannot make 26-separating voxels; use --voxelize auto or polygon";
  return {};
}

ConversionWay chooseWay(const StopRule& until, Voxelize voxelize, Separation separation) {
  if (!until.untilVoxel()) return {true, until, separation};
  if (voxelize == Voxelize::kPolygon) return {true, {.diameter = 1}, separation};
  if (voxelize == Voxelize::kAuto && separation == Separation::k26)
    return {true, {.flatness = kAutomaticFlatness}, Separation::k26};
  return {};
}

}  // namespace vox
