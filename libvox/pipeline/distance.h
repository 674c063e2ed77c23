#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// Makes the active voxels of all objects; called at most once.
using MarkVoxels = std::function<const openvdb::MaskTree&()>;

/// The grid `surface`: a narrow band of exact signed distances to the limit surfaces of all
/// objects, or to the polygons of objects that stop at a level.
///
/// What is inside is decided as for a solid density (inside.h): the active voxels and what they
/// enclose. So components are united, cavities stay, parts of a surface inside others leave no
/// trace, and holes narrower than a voxel do no harm. Where one closed surface does not meet itself
/// the side of the closest point is the same, and the voxels are not needed.
///
/// Components that enclose nothing become sheets one voxel thick, or with OpenMesh::kUnsigned
/// distances without sign.
///
/// @param part      if it has pages: only they are made, from the surface near them, if this is
///   possible; else all are
/// @param warnings  gets a line if the surface encloses only places thinner than a voxel
/// @throws MeshError   there is a part, and the surface meets itself there
/// @throws LimitError
/// @throws Cancelled
std::shared_ptr<openvdb::FloatGrid> surfaceGrid(std::span<const PreparedSurface> surfaces,
                                                const VolumeSettings& settings,
                                                const openvdb::math::Transform& transform,
                                                const MarkVoxels& markVoxels, const Region& part,
                                                MemoryBudget& budget, Progress& progress,
                                                std::vector<std::string>& warnings);

}  // namespace vox
