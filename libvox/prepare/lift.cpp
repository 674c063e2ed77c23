// Cohen, Kaufman & Wang 1994, section 2.2.

#include "libvox/prepare/lift.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/vertex_kind.h"
#include "libvox/prepare/lift_matrix.h"
#include "libvox/prepare/lift_system.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace vox {
namespace {

constexpr Index kRowsPerTask = 4096;
constexpr double kTolerance = 1e-13;  // norm of the residual, relative to the right-hand side
constexpr int kMostIterations = 100;  // 40 follow from the bound on the condition number

// Selection

std::string whyNotInterior(VertexKind kind) {
  switch (kind) {
    case VertexKind::kUnused:
      return "belongs to no face";
    case VertexKind::kTwoFaces:
      return "lies between two faces only";
    case VertexKind::kBoundary:
      return "is on the boundary; interpolate the boundary instead";
    case VertexKind::kBowTie:
      return "joins several fans of faces";
    case VertexKind::kInterior:
      break;
  }
  return {};
}

/// The vertices in increasing order, each once.
/// @throws MeshError  one does not exist or is not interior
std::vector<Index> interiorVertices(const PolygonMesh& mesh, const Adjacency& adjacency,
                                    std::span<const Index> vertices) {
  const std::vector<VertexKind> kinds = vertexKinds(mesh, adjacency);
  for (const Index v : vertices) {
    if (v >= mesh.pointCount())
      throw MeshError("vertex " + std::to_string(v) + " cannot be interpolated: there are only " +
                      std::to_string(mesh.pointCount()));
    const std::string reason = whyNotInterior(kinds[v]);
    if (!reason.empty())
      throw MeshError("vertex " + std::to_string(v) + " cannot be interpolated: it " + reason);
  }
  std::vector<Index> sorted(vertices.begin(), vertices.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

// Lifting

/// For each lifted vertex, the difference between the wanted sum of the images around it and the
/// sum that they have.
Eigen::Matrix3Xd gaps(LiftSystem& system, const PolygonMesh& mesh,
                      const std::vector<Vec3d>& wanted) {
  Eigen::Matrix3Xd gap = system.sumCorners(mesh.points);
  parallelForEach(system.rows(), kRowsPerTask, [&](Index row) {
    gap.col(row) = system.valence(row) * wanted[row] - gap.col(row);
  });
  if (!gap.allFinite())
    throw LimitError("interpolation overflows; scale the model to smaller coordinates");
  return gap;
}

/// The move of each lifted vertex. The right-hand side is scaled to size 1, because the solver
/// squares numbers, which might underflow or overflow.
Eigen::Matrix3Xd solve(LiftSystem& system, const Eigen::Matrix3Xd& gap, int& iterations) {
  const double scale = std::max(gap.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
  const Eigen::VectorXd scaled = gap.reshaped() / scale;
  const LiftMatrix matrix(system);
  Eigen::ConjugateGradient<LiftMatrix, Eigen::Lower | Eigen::Upper, ValencePreconditioner> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  solver.compute(matrix);
  const Eigen::VectorXd moves = solver.solve(scaled);
  if (solver.info() != Eigen::Success) throw LimitError("interpolation does not converge");
  iterations = static_cast<int>(solver.iterations());
  return scale * moves.reshaped(3, gap.cols());
}

double largestGap(const LiftSystem& system, const Eigen::Matrix3Xd& gap) {
  double largest = 0;
  for (Index row = 0; row < system.rows(); ++row)
    largest = std::max(largest, gap.col(row).stableNorm() / system.valence(row));
  return largest;
}

}  // namespace

PolygonMesh lift(PolygonMesh mesh, const Adjacency& adjacency, std::span<const Index> vertices,
                 LiftReport& report) {
  report = {};
  LiftSystem system(mesh, interiorVertices(mesh, adjacency, vertices));
  report.vertices = system.rows();
  if (system.rows() == 0) return mesh;

  std::vector<Vec3d> wanted(system.rows());
  for (Index row = 0; row < system.rows(); ++row) wanted[row] = mesh.points[system.vertices()[row]];
  const Eigen::Matrix3Xd moves = solve(system, gaps(system, mesh, wanted), report.iterations);
  for (Index row = 0; row < system.rows(); ++row)
    mesh.points[system.vertices()[row]] += moves.col(row);
  report.residual = largestGap(system, gaps(system, mesh, wanted));
  return mesh;
}

}  // namespace vox
