#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;

/// The grid `surface`: a narrow band of signed distances to the smooth surfaces of all objects, or
/// to the polygons of objects that stop at a level. It is made from polygons that follow the
/// surfaces within the tolerance, never from voxels.
///
/// Closed components that face outward are united. Closed components that face inward are taken out
/// of the components that they lie in. Components without inside become sheets one voxel thick, or
/// with OpenMesh::kUnsigned distances without sign. Components whose boxes do not overlap are made
/// together. Beyond 20000 closed components all are made together: faces inside others then stay as
/// seams within.
///
/// @throws LimitError
/// @throws Cancelled
std::shared_ptr<openvdb::FloatGrid> surfaceGrid(std::span<const PreparedSurface> surfaces,
                                                const VolumeSettings& settings,
                                                const openvdb::math::Transform& transform,
                                                MemoryBudget& budget, const Progress& progress);

}  // namespace vox
