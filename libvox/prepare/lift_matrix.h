#pragma once

#include "libvox/prepare/lift_system.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace vox {
class LiftMatrix;
}

template <>
struct Eigen::internal::traits<vox::LiftMatrix>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace vox {

/// A LiftSystem with the interface of a matrix for Eigen's solvers. It multiplies vectors that hold
/// the three coordinates of each lifted vertex one after another, so that one pass over the mesh
/// serves all three.
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

  /// @param system  must outlive the matrix
  explicit LiftMatrix(LiftSystem& system) : system_(system) {}

  Eigen::Index rows() const { return 3 * Eigen::Index{system_.rows()}; }
  Eigen::Index cols() const { return rows(); }

  template <class Rhs>
  Eigen::Product<LiftMatrix, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

  Eigen::VectorXd times(const Eigen::VectorXd& x) const {
    return system_.multiply(Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, system_.rows()))
        .reshaped();
  }

  /// Number of faces around the vertex of each row.
  Eigen::VectorXd valences() const {
    Eigen::VectorXd valences(rows());
    for (vox::Index row = 0; row < system_.rows(); ++row)
      valences.segment<3>(3 * Eigen::Index{row}).setConstant(system_.valence(row));
    return valences;
  }

 private:
  LiftSystem& system_;
};

/// Divides each row by the number of faces around its vertex. The bound on the condition number
/// (lift.h) holds for this scaling.
class ValencePreconditioner : public Eigen::DiagonalPreconditioner<double> {
 public:
  ValencePreconditioner& compute(const LiftMatrix& matrix) {
    m_invdiag = matrix.valences().cwiseInverse();
    m_isInitialized = true;
    return *this;
  }
};

}  // namespace vox

template <class Rhs>
struct Eigen::internal::generic_product_impl<vox::LiftMatrix, Rhs, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : generic_product_impl_base<vox::LiftMatrix, Rhs, generic_product_impl<vox::LiftMatrix, Rhs>> {
  template <class Result>
  static void scaleAndAddTo(Result& result, const vox::LiftMatrix& matrix, const Rhs& x,
                            double factor) {
    result += factor * matrix.times(x);
  }
};
