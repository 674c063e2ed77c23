#pragma once

#include "libvox/foot/cell.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Makes cells of the triangles of a mesh. Parts of the triangles can be made by several threads.
class TriangleMaker {
 public:
  /// @param mesh   triangles, in index space; neighbours use the same points. Triangles without
  ///   area have no cell. It must stay valid.
  /// @param reach  largest distance of interest, voxels
  TriangleMaker(const PolygonMesh& mesh, float reach);

  /// Adds the cells of the triangles begin .. end - 1 to a store.
  /// @param firstOwner  added to the numbers of triangles
  void add(Index begin, Index end, std::uint32_t firstOwner, CellStore& store) const;

 private:
  void addTriangle(Index triangle, std::uint32_t owner, CellStore& store) const;

  const PolygonMesh& mesh_;
  float reach_;
  std::vector<Vec3d> normals_;        // unit, of triangles; 0 without area
  std::vector<Vec3d> vertexNormals_;  // weighted by angles
  std::vector<Vec3d> edgeNormals_;    // of the edge that begins at each corner
  std::vector<double> turns_;         // of each vertex: largest sine between normals around it
};

}  // namespace vox
