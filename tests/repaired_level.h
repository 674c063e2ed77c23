#pragma once

#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"

#include <utility>

namespace vox::test {

/// Level 0 of a mesh, repaired and then scaled about the origin.
inline SubdivisionLevel repairedLevel(PolygonMesh mesh, double size = 1,
                                      BoundaryRule rule = BoundaryRule::kExtend) {
  RepairReport report;
  mesh = repair(std::move(mesh), {}, report);
  for (Vec3d& p : mesh.points) p *= size;
  return baseLevel(std::move(mesh), rule);
}
inline SubdivisionLevel repairedLevel(PolygonMesh mesh, BoundaryRule rule) {
  return repairedLevel(std::move(mesh), 1, rule);
}

}  // namespace vox::test
