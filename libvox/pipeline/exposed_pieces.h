#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/mesh/limit_piece.h"
#include "libvox/mesh/polygon_mesh.h"

namespace vox {

/// Passes on the parts of a surface that have the outside on one side at least. Where surfaces
/// overlap, the parts inside others are left out; pieces at the border are cut to less than a
/// voxel.
class ExposedPieces : public LimitSink {
 public:
  /// @param solid  voxels that surfaces cross or enclose
  /// @param depth  how far from the outside a surface is still passed on, voxels
  ExposedPieces(const openvdb::MaskTree& solid, double depth, LimitSink& next)
      : solid_(solid), depth_(depth), next_(next) {}

  void piece(const LimitPiece& piece) override;

 private:
  bool isExposedAt(const LimitPiece& piece, double u, double v) const;

  const openvdb::MaskTree& solid_;
  double depth_;
  LimitSink& next_;
};

/// The same parts of a surface of triangles; triangles at the border are cut to less than a voxel.
/// @param triangles  index space
PolygonMesh exposedTriangles(const PolygonMesh& triangles, const openvdb::MaskTree& solid,
                             double depth);

}  // namespace vox
