#pragma once

#include "libvox/core/memory.h"
#include "libvox/io/scene_file.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/pipeline/run_options.h"
#include "libvox/subdivide/doo_sabin.h"

#include <cstdint>
#include <vector>

namespace vox {

/// All objects of a scene as one mesh, after K Doo-Sabin steps; K = 0 joins them as they are.
/// @throws UsageError  levels < 0
/// @throws MeshError   an object has contradictory arrays or, for K > 0, is not an oriented
///   manifold; the message names file, object and element
/// @throws LimitError  not enough memory, or more elements than fit in 32 bits
PolygonMesh refine(const Scene& scene, int levels, const RunOptions& options);

/// Level 0 of an object. `mesh` is its mesh, in world or index space.
/// @throws MeshError   not an oriented manifold; the message names file, object and element
/// @throws LimitError  not enough memory
SubdivisionLevel baseLevelOf(const Scene& scene, const SceneObject& object, PolygonMesh mesh,
                             const MemoryBudget& budget);

/// Checks the arrays of every object (requireValidArrays), naming file and object.
void requireValidScene(const Scene& scene);

// Memory of subdivision, in bytes.

std::uint64_t bytesOf(const PolygonMesh& mesh);
std::uint64_t bytesOf(const SubdivisionLevel& level);
/// The points of the next level.
std::uint64_t bytesOfImage(const SubdivisionLevel& level);
/// What nextLevel allocates: the tables it works with and the topology it makes.
std::uint64_t bytesOfNextTopology(const SubdivisionLevel& level);

}  // namespace vox
