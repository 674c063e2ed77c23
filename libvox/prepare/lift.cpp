// Lifting by conjugate gradients on the sum of the Doo-Sabin matrices of all faces.
// Cohen, Kaufman & Wang 1994, section 2.2.

#include "libvox/prepare/lift.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/unit_root.h"
#include "libvox/mesh/vertex_kind.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace vox {
namespace {

class LiftMatrix;

}
}  // namespace vox

template <>
struct Eigen::internal::traits<vox::LiftMatrix>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace vox {
namespace {

constexpr Index kFacesPerTask = 1024;
constexpr Index kVerticesPerTask = 4096;
constexpr double kTolerance = 1e-13;
constexpr int kMostIterations = 100;  // the bound on the condition number promises 40

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

// Faces

/// Cosines and sines for every face size of a mesh, O(C) in all.
class RootTable {
 public:
  explicit RootTable(const PolygonMesh& mesh) {
    Index largest = 0;
    for (Index f = 0; f < mesh.faceCount(); ++f) largest = std::max(largest, mesh.faceSize(f));
    begin_.assign(std::size_t{largest} + 1, kNone);
    for (Index f = 0; f < mesh.faceCount(); ++f) add(mesh.faceSize(f));
  }
  const UnitRoot* of(Index n) const { return roots_.data() + begin_[n]; }

 private:
  void add(Index n) {
    if (begin_[n] != kNone) return;
    begin_[n] = static_cast<Index>(roots_.size());
    const auto more = unitRoots(n);
    roots_.insert(roots_.end(), more.begin(), more.end());
  }

  std::vector<Index> begin_;
  std::vector<UnitRoot> roots_;
};

/// Doo-Sabin image of one value per vertex, for the corners of face f:
/// U_i = V_i / 4 + 3/4 mean + 1/(2n) (A cos t_i + B sin t_i), in O(n).
template <class Value>
void imageOfFace(const PolygonMesh& mesh, Index f, const UnitRoot* roots,
                 std::span<const Value> values, std::span<Value> image) {
  const auto face = mesh.face(f);
  const auto n = static_cast<Index>(face.size());
  Value sum = values[face[0]];
  Value sumCosine = sum;
  Value sumSine = 0.0 * sum;
  for (Index i = 1; i < n; ++i) {
    const Value& value = values[face[i]];
    sum += value;
    sumCosine += roots[i].cosine * value;
    sumSine += roots[i].sine * value;
  }
  for (Index i = 0; i < n; ++i)
    image[mesh.faceOffsets[f] + i] =
        0.25 * values[face[i]] + (0.75 / n) * sum +
        (0.5 / n) * (roots[i].cosine * sumCosine + roots[i].sine * sumSine);
}

// System

/// The matrix S, its rows and columns restricted to the lifted vertices.
class LiftSystem {
 public:
  LiftSystem(const PolygonMesh& mesh, std::vector<Index> vertices)
      : mesh_(mesh), roots_(mesh), vertices_(std::move(vertices)) {
    gatherCorners();
  }

  const std::vector<Index>& vertices() const { return vertices_; }
  Index size() const { return static_cast<Index>(vertices_.size()); }
  Index valence(Index row) const { return cornerOffsets_[row + 1] - cornerOffsets_[row]; }

  /// One value per row: the sum of the images of its corners, given one value per vertex of the
  /// mesh. A row adds in the order of its corners, whoever computes it.
  template <class Value>
  std::vector<Value> cornerSums(std::span<const Value> values) const {
    std::vector<Value> image(mesh_.cornerCount());
    forEach(mesh_.faceCount(), kFacesPerTask, [&](Index f) {
      imageOfFace<Value>(mesh_, f, roots_.of(mesh_.faceSize(f)), values, image);
    });
    std::vector<Value> sums(size());
    forEachRow([&](Index row) {
      Value sum = image[corners_[cornerOffsets_[row]]];
      for (Index k = cornerOffsets_[row] + 1; k < cornerOffsets_[row + 1]; ++k)
        sum += image[corners_[k]];
      sums[row] = sum;
    });
    return sums;
  }

  template <class Work>
  void forEachRow(Work&& work) const {
    forEach(size(), kVerticesPerTask, work);
  }

  /// S x.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const {
    std::vector<double> values(mesh_.pointCount(), 0.0);
    forEachRow([&](Index row) { values[vertices_[row]] = x[row]; });
    const std::vector<double> sums = cornerSums<double>(values);
    return Eigen::Map<const Eigen::VectorXd>(sums.data(), x.size());
  }

 private:
  void gatherCorners() {
    std::vector<Index> rowOf(mesh_.pointCount(), kNone);
    for (Index row = 0; row < size(); ++row) rowOf[vertices_[row]] = row;
    cornerOffsets_.assign(std::size_t{size()} + 1, 0);
    for (const Index v : mesh_.faceVertices)
      if (rowOf[v] != kNone) ++cornerOffsets_[rowOf[v] + 1];
    for (Index row = 0; row < size(); ++row) cornerOffsets_[row + 1] += cornerOffsets_[row];
    corners_.resize(cornerOffsets_.back());
    std::vector<Index> slot(cornerOffsets_.begin(), cornerOffsets_.end() - 1);
    for (Index c = 0; c < mesh_.cornerCount(); ++c) {
      const Index row = rowOf[mesh_.faceVertices[c]];
      if (row != kNone) corners_[slot[row]++] = c;
    }
  }

  const PolygonMesh& mesh_;
  RootTable roots_;
  std::vector<Index> vertices_;
  std::vector<Index> cornerOffsets_;  ///< rows + 1: row r has corners_ [offset r, offset r + 1)
  std::vector<Index> corners_;
};

/// A LiftSystem as Eigen's solvers want to see a matrix.
class LiftMatrix : public Eigen::EigenBase<LiftMatrix> {
 public:
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = false
  };

  explicit LiftMatrix(const LiftSystem& system) : system_(system) {}
  Eigen::Index rows() const { return system_.size(); }
  Eigen::Index cols() const { return system_.size(); }
  const LiftSystem& system() const { return system_; }

  template <class Rhs>
  Eigen::Product<LiftMatrix, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

 private:
  const LiftSystem& system_;
};

/// Divides by the number of faces around each vertex: the scaling for which the bound is proved.
class ValencePreconditioner {
 public:
  ValencePreconditioner() = default;
  ValencePreconditioner& analyzePattern(const LiftMatrix&) { return *this; }
  ValencePreconditioner& factorize(const LiftMatrix& matrix) {
    inverse_.resize(matrix.rows());
    matrix.system().forEachRow([&](Index row) {
      inverse_[row] = 1.0 / static_cast<double>(matrix.system().valence(row));
    });
    return *this;
  }
  ValencePreconditioner& compute(const LiftMatrix& matrix) { return factorize(matrix); }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return inverse_.cwiseProduct(b); }
  static Eigen::ComputationInfo info() { return Eigen::Success; }

 private:
  Eigen::VectorXd inverse_;
};

}  // namespace
}  // namespace vox

namespace Eigen::internal {

template <class Rhs>
struct generic_product_impl<vox::LiftMatrix, Rhs, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<vox::LiftMatrix, Rhs, generic_product_impl<vox::LiftMatrix, Rhs>> {
  template <class Result>
  static void scaleAndAddTo(Result& result, const vox::LiftMatrix& matrix, const Rhs& x,
                            double factor) {
    result += factor * matrix.system().times(x);
  }
};

}  // namespace Eigen::internal

namespace vox {
namespace {

/// How far the images around each lifted vertex, summed up, are from where they should be.
std::vector<Vec3d> gaps(const LiftSystem& system, std::span<const Vec3d> points,
                        std::span<const Vec3d> wanted) {
  std::vector<Vec3d> sums = system.cornerSums<Vec3d>(points);
  system.forEachRow(
      [&](Index row) { sums[row] = double(system.valence(row)) * wanted[row] - sums[row]; });
  return sums;
}

/// Solves for one coordinate of the displacements; returns the number of steps.
int solveCoordinate(const LiftMatrix& matrix, const std::vector<Vec3d>& gap, int axis,
                    PolygonMesh& mesh) {
  Eigen::ConjugateGradient<LiftMatrix, Eigen::Lower | Eigen::Upper, ValencePreconditioner> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  solver.compute(matrix);
  Eigen::VectorXd rhs(matrix.rows());
  for (std::size_t row = 0; row < gap.size(); ++row)
    rhs[static_cast<Eigen::Index>(row)] = gap[row][axis];
  const Eigen::VectorXd move = solver.solve(rhs);
  if (solver.info() != Eigen::Success || !move.allFinite())
    throw LimitError("interpolation does not converge; scale the model to smaller coordinates");
  matrix.system().forEachRow(
      [&](Index row) { mesh.points[matrix.system().vertices()[row]][axis] += move[row]; });
  return static_cast<int>(solver.iterations());
}

double largestGap(const LiftSystem& system, const std::vector<Vec3d>& gap) {
  double largest = 0;
  for (Index row = 0; row < system.size(); ++row)
    largest = std::max(largest, gap[row].norm() / system.valence(row));
  return largest;
}

}  // namespace

PolygonMesh lift(PolygonMesh mesh, const Adjacency& adjacency, std::span<const Index> vertices,
                 LiftReport& report) {
  report = {};
  const LiftSystem system(mesh, interiorVertices(mesh, adjacency, vertices));
  report.vertices = system.size();
  if (system.size() == 0) return mesh;

  std::vector<Vec3d> wanted(system.size());
  system.forEachRow([&](Index row) { wanted[row] = mesh.points[system.vertices()[row]]; });
  const std::vector<Vec3d> gap = gaps(system, mesh.points, wanted);
  const LiftMatrix matrix(system);
  for (const int axis : {0, 1, 2})
    report.iterations = std::max(report.iterations, solveCoordinate(matrix, gap, axis, mesh));
  report.residual = largestGap(system, gaps(system, mesh.points, wanted));
  return mesh;
}

}  // namespace vox
