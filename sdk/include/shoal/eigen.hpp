// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Eigen views of Vec and Mat, for the algebra of single particles (eigenvalues, decompositions). No copy is made;
// the view lives as long as the Vec. Not for pair code. The only SDK header that includes Eigen.
#pragma once

#include <Eigen/Core>

#include "shoal/vec.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

template <int D>
Eigen::Map<Eigen::Matrix<double, D, 1>> as_eigen(Vec<D>& a) {
  return Eigen::Map<Eigen::Matrix<double, D, 1>>(a.e);
}
template <int D>
Eigen::Map<const Eigen::Matrix<double, D, 1>> as_eigen(const Vec<D>& a) {
  return Eigen::Map<const Eigen::Matrix<double, D, 1>>(a.e);
}
template <int D>
Eigen::Map<Eigen::Matrix<double, D, D, Eigen::RowMajor>> as_eigen(Mat<D>& a) {
  return Eigen::Map<Eigen::Matrix<double, D, D, Eigen::RowMajor>>(a.e);
}
template <int D>
Eigen::Map<const Eigen::Matrix<double, D, D, Eigen::RowMajor>> as_eigen(const Mat<D>& a) {
  return Eigen::Map<const Eigen::Matrix<double, D, D, Eigen::RowMajor>>(a.e);
}
// A view of a temporary would dangle.
template <int D>
void as_eigen(const Vec<D>&&) = delete;
template <int D>
void as_eigen(const Mat<D>&&) = delete;

/// Copies of any Eigen expression of the right shape.
template <int D, class Derived>
Vec<D> to_vec(const Eigen::MatrixBase<Derived>& a) {
  Vec<D> r;
  as_eigen(r) = a;
  return r;
}
template <int D, class Derived>
Mat<D> to_mat(const Eigen::MatrixBase<Derived>& a) {
  Mat<D> r;
  as_eigen(r) = a;
  return r;
}

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
