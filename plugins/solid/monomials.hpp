// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The quadratic monomials of the fits in the reference configuration.
#pragma once

// gcc 12 warns about its own AVX-512 headers; matrices of 5 and 9 rows gain nothing from them.
#define EIGEN_DONT_VECTORIZE
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "shoal/vec.hpp"

namespace shoal::solid {

template <int D>
inline constexpr int n_monomials = D + D*(D + 1) / 2;
template <int D>
using Monomials = Eigen::Matrix<double, n_monomials<D>, 1>;
template <int D>
using Moments = Eigen::Matrix<double, n_monomials<D>, n_monomials<D>>;

// X, Y, (Z,) X^2, X Y, ...
template <int D>
Monomials<D> monomials(const Vec<D>& d) {
  Monomials<D> p;
  int k = D;
  for (int a = 0; a < D; ++a) {
    p[a] = d[a];
    for (int b = a; b < D; ++b) p[k++] = d[a] * d[b];
  }
  return p;
}

// Whether a factorisation of moments can be trusted: false where there are too few neighbours for a quadratic fit.
template <int D>
bool well_conditioned(const Eigen::LLT<Moments<D>>& llt) {
  if (llt.info() != Eigen::Success) return false;
  double largest = 0, least = HUGE_VAL;
  for (int k = 0; k < n_monomials<D>; ++k) {
    largest = std::max(largest, llt.matrixLLT()(k, k));
    least = std::min(least, llt.matrixLLT()(k, k));
  }
  return least > 1e-3 * largest;
}

}  // namespace shoal::solid
