#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>

namespace vox {

/// Counts and accuracy of lift.
struct LiftReport {
  Index vertices = 0;   ///< number of lifted vertices
  int iterations = 0;   ///< of conjugate gradients
  double residual = 0;  ///< largest distance of a V-face's centroid from the point to interpolate
};

/// Lifting: moves the given vertices so that the limit surface passes through their old positions.
/// All other vertices stay. A vertex given twice counts once.
///
/// Solves S W = m V. Row i states that the mean of the m_i corner images around vertex i is V_i. S
/// is the sum over faces of the Doo-Sabin matrices, symmetric and between diag(m) / 4 and diag(m).
/// So for any mesh and any subset of its vertices, conjugate gradients scaled by diag(m) need about
/// 25 steps and at most 40. Matrix-free: cost O(C + V), also for faces and vertices of thousands of
/// sides. Parallel; result independent of thread count.
///
/// @throws MeshError   a vertex does not exist, or is not interior with one closed one-ring of 3
///   faces or more; the message names it
/// @throws LimitError  coordinates are so large that their sums overflow
/// Source: paper section 2.2; DESIGN section 5.
PolygonMesh lift(PolygonMesh mesh, const Adjacency& adjacency, std::span<const Index> vertices,
                 LiftReport& report);

}  // namespace vox
