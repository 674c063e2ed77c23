#pragma once

#include "libvox/core/unit_root.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// The linear system of lifting: the matrix S is the sum over all faces of their Doo-Sabin
/// matrices, with rows and columns for the lifted vertices only. It is never stored, but applied to
/// three coordinates at once: O(C + V) each time, also for faces and vertices of thousands of
/// sides. Parallel; results independent of thread count. Only one thread may call a system at a
/// time, because it keeps its working memory.
class LiftSystem {
 public:
  /// @param mesh      must outlive the system; its faces must not change
  /// @param vertices  the lifted ones, each once; each must have a face
  LiftSystem(const PolygonMesh& mesh, std::vector<Index> vertices);

  const std::vector<Index>& vertices() const { return vertices_; }
  Index rows() const { return static_cast<Index>(vertices_.size()); }

  /// Number of faces around the vertex of a row.
  double valence(Index row) const { return cornerOffsets_[row + 1] - cornerOffsets_[row]; }

  /// For each row, the sum of the images of the corners at its vertex, added in their order.
  /// @param positions  one for each vertex of the mesh
  Eigen::Matrix3Xd sumCorners(std::span<const Vec3d> positions);

  /// S x: as sumCorners, with the lifted vertices at x and all others at the origin.
  Eigen::Matrix3Xd multiply(const Eigen::Ref<const Eigen::Matrix3Xd>& x);

 private:
  void collectRoots();
  void collectCorners();
  void imageOfFace(Index f, std::span<const Vec3d> positions);

  const PolygonMesh& mesh_;
  std::vector<Index> vertices_;
  std::vector<Index> cornerOffsets_;  ///< rows + 1: row r has corners_ [offset r, offset r + 1)
  std::vector<Index> corners_;
  std::vector<Index> rootOffsets_;  ///< by face size: first of its roots_; kNone if no face has it
  std::vector<UnitRoot> roots_;
  std::vector<Vec3d> positions_;  ///< of all vertices, for multiply
  std::vector<Vec3d> images_;     ///< of all corners
};

}  // namespace vox
