// Conjugate gradients on the three coordinates at once: they share every pass over the mesh, each
// has its own steps.
// Cohen, Kaufman & Wang 1994, section 2.2.

#include "libvox/prepare/lift.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/vertex_kind.h"
#include "libvox/prepare/lift_system.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace vox {
namespace {

using Triple = Eigen::Array3d;  // a number for each coordinate

constexpr Index kRowsPerPart = 4096;
constexpr double kTolerance = 1e-13;  // norm of the residual, relative to the right-hand side
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

// Conjugate gradients

/// The sum of work(row) over all rows. Parts of fixed size are summed in parallel and added up in
/// order, so the bits do not depend on the number of threads.
template <class Work>
auto sumOverRows(Index rows, Work&& work) {
  using Sum = decltype(work(Index{0}));
  std::vector<Sum> parts((std::size_t{rows} + kRowsPerPart - 1) / kRowsPerPart);
  forEach(parts.size(), 1, [&](std::size_t part) {
    const auto begin = static_cast<Index>(part * kRowsPerPart);
    const Index end = std::min(rows, begin + kRowsPerPart);
    Sum sum = work(begin);
    for (Index row = begin + 1; row < end; ++row) sum += work(row);
    parts[part] = sum;
  });
  Sum all = parts[0];
  for (std::size_t part = 1; part < parts.size(); ++part) all += parts[part];
  return all;
}

Triple times(const Vec3d& a, const Vec3d& b) {
  return a.array() * b.array();
}

/// Solves S x = b for three columns, scaled by the valences: the scaling for which the bound on the
/// condition number is proved. A column that has converged stays.
class Gradients {
 public:
  /// @param b  at least one row, numbers of a size whose squares neither vanish nor overflow
  Gradients(LiftSystem& system, std::vector<Vec3d> b)
      : system_(system),
        x_(b.size(), Vec3d::Zero()),
        residual_(std::move(b)),
        direction_(residual_.size()) {
    for (Index row = 0; row < system.rows(); ++row)
      direction_[row] = residual_[row] * (1 / system.valence(row));
    scaledNorm_ = sumOverRows(system_.rows(),
                              [&](Index row) { return times(residual_[row], direction_[row]); });
    norm_ = sumOverRows(system_.rows(),
                        [&](Index row) { return times(residual_[row], residual_[row]); });
    limit_ = kTolerance * kTolerance * norm_;
  }

  /// Steps until every column has converged; @return whether they have.
  bool run() {
    for (; iterations_ < kMostIterations; ++iterations_) {
      if (!norm_.isFinite().all()) return false;
      if ((norm_ <= limit_).all()) return true;
      step();
    }
    return false;
  }

  int iterations() const { return iterations_; }
  const std::vector<Vec3d>& solution() const { return x_; }

 private:
  void step() {
    const auto open = (norm_ > limit_).eval();
    system_.multiply(direction_, product_);
    const Triple curvature = sumOverRows(
        system_.rows(), [&](Index row) { return times(direction_[row], product_[row]); });
    const Triple length = open.select(scaledNorm_ / curvature, 0.0);
    using Norms = Eigen::Array<double, 3, 2>;
    const Norms norms = sumOverRows(system_.rows(), [&](Index row) {
      x_[row].array() += length * direction_[row].array();
      residual_[row].array() -= length * product_[row].array();
      const Triple square = times(residual_[row], residual_[row]);
      Norms both;
      both << square * (1 / system_.valence(row)), square;
      return both;
    });
    const Triple turn = open.select(norms.col(0) / scaledNorm_, 0.0);
    scaledNorm_ = norms.col(0);
    norm_ = norms.col(1);
    forEach(system_.rows(), kRowsPerPart, [&](Index row) {
      direction_[row] =
          residual_[row] / system_.valence(row) + (turn * direction_[row].array()).matrix();
    });
  }

  LiftSystem& system_;
  std::vector<Vec3d> x_;
  std::vector<Vec3d> residual_;
  std::vector<Vec3d> direction_;
  std::vector<Vec3d> product_;
  Triple norm_;        // of the residual, squared
  Triple scaledNorm_;  // the same, each row divided by its valence
  Triple limit_;
  int iterations_ = 0;
};

// Lifting

/// How far the images around each lifted vertex, summed up, are from where they should be.
std::vector<Vec3d> gaps(LiftSystem& system, const PolygonMesh& mesh,
                        const std::vector<Vec3d>& wanted) {
  std::vector<Vec3d> gap;
  system.sumCorners(mesh.points, gap);
  forEach(system.rows(), kRowsPerPart,
          [&](Index row) { gap[row] = system.valence(row) * wanted[row] - gap[row]; });
  return gap;
}

/// The power of two next to the largest coordinate: dividing by it is exact.
double scaleOf(const std::vector<Vec3d>& vectors) {
  double largest = 0;
  for (const Vec3d& v : vectors) largest = std::max(largest, v.lpNorm<Eigen::Infinity>());
  if (largest == 0 || !std::isfinite(largest)) return 1;
  return std::ldexp(1.0, std::ilogb(largest));
}

double largestGap(const LiftSystem& system, const std::vector<Vec3d>& gap) {
  double largest = 0;
  for (Index row = 0; row < system.rows(); ++row)
    largest = std::max(largest, gap[row].stableNorm() / system.valence(row));
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
  std::vector<Vec3d> gap = gaps(system, mesh, wanted);
  const double scale = scaleOf(gap);
  for (Vec3d& g : gap) g /= scale;
  Gradients gradients(system, std::move(gap));
  if (!gradients.run())
    throw LimitError("interpolation does not converge; scale the model to smaller coordinates");
  for (Index row = 0; row < system.rows(); ++row)
    mesh.points[system.vertices()[row]] += scale * gradients.solution()[row];
  report.iterations = gradients.iterations();
  report.residual = largestGap(system, gaps(system, mesh, wanted));
  return mesh;
}

}  // namespace vox
