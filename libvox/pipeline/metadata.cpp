// What a file says of how it was made (DESIGN section 14).

#include "libvox/pipeline/metadata.h"

#include "libvox/core/version.h"
#include "libvox/grid/openvdb.h"
#include "libvox/options/voxelize.h"

#include <algorithm>
#include <sstream>

namespace vox {
namespace {

std::string optionText(const GridTransform& transform, const Scene& scene,
                       const ConvertOptions& options) {
  std::ostringstream text;
  text.precision(17);
  if (options.voxelSize || (!options.dim && scene.voxelSize))
    text << "voxel-size=" << transform.voxelSize;
  else
    text << "dim=" << options.dim.value_or(scene.dim.value_or(kDefaultDim));
  const SmoothingOptions& smoothing = options.smoothing;
  if (smoothing.boundary) text << " boundary=" << nameIn(kBoundaryRuleNames, *smoothing.boundary);
  if (smoothing.interpolate)
    text << " interpolate=" << nameIn(kInterpolateNames, *smoothing.interpolate);
  if (smoothing.interpolatedVertices)
    text << " interpolated-vertices=" << smoothing.interpolatedVertices->size();
  if (options.weldTolerance) text << " weld=" << *options.weldTolerance;
  if (options.texture) text << " texture=" << textureText(*options.texture);
  if (options.volume.fill) text << " fill=" << nameIn(kFillNames, *options.volume.fill);
  if (options.volume.gain) text << " gain=" << *options.volume.gain;
  if (options.volume.openMesh)
    text << " open-mesh=" << nameIn(kOpenMeshNames, *options.volume.openMesh);
  if (options.volume.band) text << " band=" << *options.volume.band;
  if (options.volume.tolerance) text << " tolerance=" << *options.volume.tolerance;
  if (options.volume.half.value_or(false)) text << " half";
  if (options.volume.target) text << " target=" << nameIn(kTargetNames, *options.volume.target);
  if (options.volume.up) text << " up=" << nameIn(kUpAxisNames, *options.volume.up);
  if (options.until) text << " until=" << stopRuleName(*options.until);
  if (options.voxelize) text << " voxelize=" << nameIn(kVoxelizeNames, *options.voxelize);
  return text.str();
}

}  // namespace

openvdb::MetaMap describe(const Scene& scene, const ConvertOptions& options,
                          const GridTransform& transform, const ConvertReport& report) {
  int levels = 0;
  for (const ObjectReport& object : report.objects) levels = std::max(levels, object.levels);
  const auto voxels = static_cast<openvdb::Int64>(report.activeVoxels);
  const char* guarantee = options.separation == Separation::k26 ? "26-separating" : "6-separating";
  openvdb::MetaMap metadata;
  metadata.insertMeta("vox_version", openvdb::StringMetadata(version()));
  if (!scene.files.empty()) {
    metadata.insertMeta("vox_input", openvdb::StringMetadata(scene.files[0].filename().string()));
    metadata.insertMeta("vox_input_hash", openvdb::StringMetadata(scene.inputHash));
  }
  metadata.insertMeta("vox_options",
                      openvdb::StringMetadata(optionText(transform, scene, options)));
  if (report.activeVoxels == 0) return metadata;  // a level set needs none
  metadata.insertMeta("vox_levels", openvdb::Int32Metadata(levels));
  metadata.insertMeta("vox_guarantee", openvdb::StringMetadata(guarantee));
  metadata.insertMeta("vox_active_voxels", openvdb::Int64Metadata(voxels));
  return metadata;
}

}  // namespace vox
