#pragma once

#include "libvox/core/origins.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/preparation_options.h"
#include "libvox/options/run_options.h"
#include "libvox/pipeline/request.h"
#include "libvox/prepare/crease.h"
#include "libvox/prepare/interpolate.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/vertex_places.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

struct Refinement {
  PolygonMesh mesh;  ///< with the colours of points and faces of the objects, grey where they lack
  std::vector<std::string> warnings;  ///< one line each
};

/// All objects of a scene as one mesh, after K Doo-Sabin steps; K = 0 gives the control meshes:
/// repaired, oriented, and lifted where vertices are interpolated. Colours of points are subdivided
/// as the points are; the first step turns those of faces into colours of points. The progress
/// keeps a share for writing the mesh: beginLast.
/// @throws UsageError  levels < 0; as requirePreparable and prepare
/// @throws MeshError   an object has contradictory arrays, or cannot be prepared; the message names
///   file, object and element
/// @throws LimitError  not enough memory, or more elements than fit in 32 bits
/// @throws Cancelled
Refinement refine(const Scene& scene, int levels, const PreparationOptions& preparation,
                  const RunOptions& run);

/// Level 0 of an object, ready to subdivide.
struct PreparedObject {
  SubdivisionLevel base;
  CreaseCounts creases;
  InterpolationReport interpolation;
  std::vector<std::string> warnings;
  Origins faceOrigin;            ///< per face: the face of the object's mesh
  std::vector<Vec2f> texcoords;  ///< per corner, if they follow; or empty
};

/// Prepares the objects of a scene, one after the other, for so many Doo-Sabin steps, and hands
/// each to `visit` with its number. In visit, the current stage of the progress is "subdivide"; the
/// budget holds the inputs.
/// @param keepsTexcoords  texture coordinates follow
/// @throws as refine
using VisitPrepared = std::function<void(std::size_t, PreparedObject, MemoryBudget&, Progress&)>;
void prepareEach(const Scene& scene, int levels, const PreparationOptions& preparation,
                 const RunOptions& run, bool keepsTexcoords, const VisitPrepared& visit);

/// Box of the components of an object that are not dropped, in world units.
/// @throws MeshError  all are dropped; the message names file and object
Box keptBox(const Scene& scene, const SceneObject& object, const ObjectPreparation& preparation);

/// What is said of the gaps of an object (gaps.h), in world units.
std::string gapsOf(const SceneObject& object, const ObjectPreparation& preparation);

/// Prepares an object in world space: dropping of debris, repair, orientation, creases,
/// interpolation.
/// Credits the current stage of `progress`.
/// @param usedUp  the mesh of the object, which is not needed any more; null: it is copied
/// @throws UsageError  the weld tolerance is negative or not finite
/// @throws MeshError   something had to be repaired or turned round though `strict` forbids it, or
///   smoothing groups or edges that should be sharp are missing though it does, nothing is left
///   after repair, or a vertex cannot be interpolated; the message names file, object and element
/// @throws LimitError  not enough memory
/// @throws Cancelled
PreparedObject prepare(const Scene& scene, const SceneObject& object,
                       const ObjectPreparation& preparation, const MemoryBudget& budget,
                       Progress& progress, PolygonMesh* usedUp = nullptr);

/// Whether the colours of a mesh are subdivided with it, or dropped.
enum class Colors { kDropped, kKept };

/// K Doo-Sabin steps.
/// @param places  receives those of the vertices of the last level, if there is a step; may be null
/// @throws LimitError  a level does not fit into the budget, or has 2^32 - 1 corners or more
SubdivisionLevel subdividedWithin(const MemoryBudget& budget, SubdivisionLevel level, int levels,
                                  Progress& progress, Colors colors = Colors::kDropped,
                                  std::vector<VertexPlace>* places = nullptr);

/// What a caller of subdividedWithin may tell a user whose levels do not fit into memory.
inline constexpr const char* kRefineAdvice = "use fewer levels, or raise --max-memory";

/// Checks the arrays of every object (requireValidArrays).
/// @throws MeshError  the message names file and object
void requireValidScene(const Scene& scene);

// Memory of subdivision, in bytes.

std::uint64_t bytesOf(const PolygonMesh& mesh);
std::uint64_t bytesOf(const SubdivisionLevel& level);
/// The points of the next level.
std::uint64_t bytesOfImage(const SubdivisionLevel& level);
/// What nextLevel allocates: the tables it works with and the topology it makes.
std::uint64_t bytesOfNextTopology(const SubdivisionLevel& level);

}  // namespace vox
