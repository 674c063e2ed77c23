#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/prepared_surface.h"

#include <span>
#include <vector>

namespace vox {

class Progress;

/// Which voxels are inside.
struct Inside {
  const openvdb::MaskTree* surface = nullptr;  ///< voxels that a surface crosses
  const openvdb::MaskTree* solid = nullptr;    ///< these, and what they enclose
};

/// Whether each component of a surface has an inside: a closed one has, and an open one if its
/// inner side is mostly solid, so that its holes are narrower than a voxel. The others are sheets.
/// @param inside  of all objects
/// @throws Cancelled
std::vector<bool> haveInside(const PreparedSurface& surface,
                             std::span<const MeshComponent> components, const Inside& inside,
                             Progress& progress);

/// The components of an object.
struct BodiesAndSheets {
  std::vector<MeshComponent> bodies;  ///< with inside
  std::vector<Index> sheets;          ///< faces of the others, ascending
};
BodiesAndSheets bodiesAndSheets(const PreparedSurface& surface, const Inside& inside,
                                Progress& progress);

/// Voxels of `inside.solid` that a surface crosses, but none of a level set, and that lie at the
/// outside: sheets beside bodies are as active as these.
/// @param band  level set of the bodies
std::vector<openvdb::Coord> sheetVoxels(const Inside& inside, const openvdb::FloatTree& band,
                                        double voxelSize);

}  // namespace vox
