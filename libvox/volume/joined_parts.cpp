// The voxels of all parts of a density.

#include "libvox/volume/joined_parts.h"

#include "libvox/options/part_options.h"

namespace vox {

openvdb::MaskGrid::Ptr joinedParts(std::span<const openvdb::GridBase::Ptr> grids) {
  openvdb::MaskGrid::Ptr joined;
  for (const auto& grid : grids) {
    const auto part = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!part || !(*part)[kPartNameMetadata]) continue;
    if (!joined) {
      joined = openvdb::MaskGrid::create();
      joined->insertMeta(*part);
      joined->removeMeta(kPartNameMetadata);
      joined->setName("density");
      joined->setTransform(part->transform().copy());
    }
    if (part->transform() == joined->transform()) joined->tree().topologyUnion(part->tree());
  }
  return joined;
}

}  // namespace vox
