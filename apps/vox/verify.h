#pragma once

#include "libvox/core/error.h"
#include "libvox/grid/openvdb_fwd.h"
#include "libvox/inspect/separation.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/request.h"

#include <string>
#include <vector>

namespace vox::app {

/// Tunnels of one object of a scene.
struct ObjectCheck {
  std::string name;
  SeparationReport separation;
};

/// Looks for tunnels of the surfaces of a scene, object by object. Each surface is made again, as a
/// whole, level by level: down to faces that fit into a voxel, or to the level of its stop rule. If
/// polygons stop at different levels, the voxels are compared with these, and with a level of the
/// whole mesh as far as the polygons are from it.
/// @param request    as for the conversion
/// @param voxelSize  of the voxels, world units
/// @throws LimitError  a refined mesh does not fit into memory; and all that prepare throws
std::vector<ObjectCheck> checkObjects(const openvdb::MaskTree& voxels, const Scene& scene,
                                      const Request& request, double voxelSize);

/// The check found a fault.
class CheckFailed : public Error {
 public:
  using Error::Error;
  int exitCode() const noexcept override { return 1; }
};

/// Checks what a conversion has made: that the voxels separate the sides of every surface, and that
/// lint finds no fault in any grid.
/// @throws CheckFailed  names the first fault
/// @throws UsageError   there is neither a mask nor a density grid; and all that checkObjects
///   throws
void verify(const Conversion& conversion, const Scene& scene, const Request& request);

/// "no tunnels", or how many and where.
std::string separationText(const SeparationReport& report);

}  // namespace vox::app
