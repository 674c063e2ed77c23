// What a file tells of how it was made (DESIGN section 14).

#include "libvox/pipeline/metadata.h"

#include "libvox/core/version.h"
#include "libvox/grid/openvdb.h"
#include "libvox/options/option_text.h"
#include "libvox/options/voxelize.h"

#include <algorithm>

namespace vox {

openvdb::MetaMap describe(const Scene& scene, const Request& request, const ConvertReport& report) {
  int levels = 0;
  for (const ObjectReport& object : report.objects) levels = std::max(levels, object.levels);
  const auto voxels = static_cast<openvdb::Int64>(report.activeVoxels);
  openvdb::MetaMap metadata;
  const auto insertText = [&](const char* key, const std::string& text) {
    metadata.insertMeta(key, openvdb::StringMetadata(text));
  };
  insertText("vox_version", version());
  if (!scene.files.empty()) {
    insertText("vox_input", scene.files[0].filename().string());
    insertText("vox_input_hash", report.inputHash);
  }
  insertText(kOptionsMetadata, request.optionText);
  if (report.activeVoxels == 0) return metadata;  // a level set needs none
  metadata.insertMeta("vox_levels", openvdb::Int32Metadata(levels));
  insertText(kGuaranteeMetadata, guaranteeText(request.separation));
  metadata.insertMeta("vox_active_voxels", openvdb::Int64Metadata(voxels));
  return metadata;
}

}  // namespace vox
