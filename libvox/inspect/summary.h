#pragma once

#include "libvox/grid/transform.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/mesh/validate.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vox {

/// Properties of a mesh; they do not depend on the winding of its faces. Edges are undirected and
/// count once, with any number of faces. Points that no face uses do not count for the Euler
/// characteristic.
struct MeshSummary {
  std::uint64_t points = 0;
  std::uint64_t faces = 0;
  std::uint64_t edges = 0;
  std::uint64_t components = 0;  ///< of faces joined through edges
  bool closed = true;            ///< no edge has only one face
  bool orientable = true;        ///< faces can be wound so that edges of two faces run both ways
  /// Handles of all components together: of closed orientable meshes of edges of two faces and
  /// vertices of one fan.
  std::optional<std::int64_t> genus;
  std::int64_t eulerCharacteristic = 0;  ///< used points - edges + faces
  /// Number of edges in each chain of edges of one face that meet in vertices, by lowest edge.
  std::vector<std::uint64_t> boundaryLoops;
  std::map<std::uint64_t, std::uint64_t> faceSizes;  ///< corners of a face -> number of faces
  std::map<std::uint64_t, std::uint64_t> valences;   ///< edges at a used point -> number of points
  Box box;                                           ///< of the points that faces use, world units
  std::vector<Defect> defects;
};

/// @throws MeshError  the arrays are not valid (requireValidArrays)
MeshSummary summarize(const PolygonMesh& mesh);

/// Properties of a grid of a .vdb file.
struct GridSummary {
  std::string name;
  std::string type;       ///< OpenVDB's name: "Tree_float_5_4_3"
  std::string gridClass;  ///< "fog volume"
  std::uint64_t activeVoxels = 0;
  std::uint64_t leaves = 0;
  std::uint64_t memoryBytes = 0;
  std::array<int, 3> low{};   ///< bounding box of the active voxels, index space, inclusive;
  std::array<int, 3> high{};  ///< meaningless when there are none
  std::array<double, 3> voxelSize{};  ///< world units
  std::array<double, 3> origin{};     ///< world position of the centre of voxel (0, 0, 0)
  std::map<std::string, std::string> metadata;
};

/// Summaries of all grids of a .vdb file, in file order.
/// @throws InputError  the file is missing or not a .vdb file that OpenVDB can read
std::vector<GridSummary> summarizeVdb(const std::filesystem::path& file);

}  // namespace vox
