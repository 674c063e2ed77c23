#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>

namespace vox {

/// What lifting did.
struct LiftReport {
  Index vertices = 0;   ///< lifted
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< largest distance from a V-face's centroid to where it should be
};

/// Lifting: moves the given vertices so that the limit surface passes through where they were; all
/// others stay. A vertex given twice counts once.
///
/// Solves S W = m V: row i says that the corner images around vertex i, of which there are m_i,
/// have their mean at V_i. S is the sum over faces of the Doo-Sabin matrices, symmetric and between
/// diag(m) / 4 and diag(m); so on any subset of vertices, whatever the mesh, conjugate gradients
/// scaled by diag(m) need about 25 steps and at most 40. Matrix-free: cost O(C + V), also for
/// faces and vertices of thousands of sides. Parallel; result independent of thread count.
///
/// @throws MeshError   a vertex is not an interior one with one ring of 3 or more faces, or does
///   not exist; the message names it
/// @throws LimitError  coordinates so large that sums of them overflow
/// Source: paper section 2.2; DESIGN section 5.
PolygonMesh lift(PolygonMesh mesh, const Adjacency& adjacency, std::span<const Index> vertices,
                 LiftReport& report);

}  // namespace vox
