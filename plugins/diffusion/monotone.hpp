// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The non-negative weights of the monotone scheme (limiter.hpp): those of the fit with the condition that none is
// negative, so that c stays between its neighbours and the data of surfaces, for any tensor.
//   minimise  sum_j l_j^2 / (2 W_j) + |d^(-1/2) (sum_j l_j p_j - g)|^2 / 2,   l_j >= 0
// p_j are the rows of the fit and g what they have to add up to (fit.hpp). Where l >= 0 was no condition, or can be met,
// the moments are exact up to d and the scheme is consistent of second order; else second moments are missed: some
// diffusion is added. Rows of given fluxes carry no c and may have any sign. The dual problem has as many unknowns m as
// the fit,
//   l_j = W_j max(0, p_j . m),   sum_j l_j p_j + d m = g,
// the gradient of a convex function: Newton's method with step control, ten iterations or so.
// How much is added depends on the angle between the principal axis and the lines from particle to particle: larger
// smoothing ratios offer more of these.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "small_matrix.hpp"

namespace shoal::diffusion {

template <int N>
struct MonotoneRow {
  SmallVector<N> p;
  double weight;
  bool bounded;  // l >= 0
};

namespace impl {

// Value and, if wanted, gradient and Hessian of the dual function at m.
template <int N>
double dual(const std::vector<MonotoneRow<N>>& rows, const SmallVector<N>& g, const SmallVector<N>& d,
            const SmallVector<N>& m, SmallVector<N>* gradient, SmallMatrix<N>* hessian) {
  double value = 0;
  if (gradient != nullptr) *gradient = {}, *hessian = {};
  for (const auto& row : rows) {
    double along = 0;
    for (std::size_t a = 0; a < N; ++a) along += row.p[a] * m[a];
    if (row.bounded && along <= 0.0) continue;
    value += 0.5 * row.weight * along * along;
    if (gradient == nullptr) continue;
    for (std::size_t a = 0; a < N; ++a) {
      (*gradient)[a] += row.weight * along * row.p[a];
      for (std::size_t b = 0; b < N; ++b)
        (*hessian)(static_cast<int>(a), static_cast<int>(b)) += row.weight * row.p[a] * row.p[b];
    }
  }
  for (std::size_t a = 0; a < N; ++a) {
    value += m[a] * (0.5 * d[a] * m[a] - g[a]);
    if (gradient == nullptr) continue;
    (*gradient)[a] += d[a] * m[a] - g[a];
    (*hessian)(static_cast<int>(a), static_cast<int>(a)) += d[a];
  }
  return value;
}

// The multipliers without bounds: those of the fit.
template <int N>
SmallVector<N> unbounded_multipliers(const std::vector<MonotoneRow<N>>& rows, const SmallVector<N>& g,
                                     const SmallVector<N>& d) {
  SmallMatrix<N> moments;
  for (int a = 0; a < N; ++a) {
    moments(a, a) = d[static_cast<std::size_t>(a)];
    for (int b = 0; b < N; ++b)
      for (const auto& row : rows)
        moments(a, b) += row.weight * row.p[static_cast<std::size_t>(a)] * row.p[static_cast<std::size_t>(b)];
  }
  SmallVector<N> m{};
  if (invert(moments) == 0.0) return m;
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b)
      m[static_cast<std::size_t>(a)] += moments(a, b) * g[static_cast<std::size_t>(b)];
  return m;
}

}  // namespace impl

// The multipliers m of the rows in D dimensions.
template <int D, int N>
SmallVector<N> monotone_multipliers(const std::vector<MonotoneRow<N>>& rows, const SmallVector<N>& g) {
  double trace = 0;
  for (const auto& row : rows)
    for (std::size_t a = 0; a < N; ++a) trace += row.weight * row.p[a] * row.p[a];
  // First moments, which would let c drift, are held more firmly than second ones.
  SmallVector<N> d{}, m{}, gradient{};
  for (std::size_t a = 0; a < N; ++a) d[a] = (a < D ? 1e-8 : 1e-6) * trace / N;
  m = impl::unbounded_multipliers<N>(rows, g, d);
  double value = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    SmallMatrix<N> hessian;
    value = impl::dual<N>(rows, g, d, m, &gradient, &hessian);
    if (invert(hessian) == 0.0) break;
    SmallVector<N> direction{};
    double slope = 0;
    for (std::size_t a = 0; a < N; ++a) {
      for (std::size_t b = 0; b < N; ++b)
        direction[a] -= hessian(static_cast<int>(a), static_cast<int>(b)) * gradient[b];
      slope += direction[a] * gradient[a];
    }
    if (!(slope < -1e-22 * std::abs(value))) break;
    for (double step = 1.0; step > 1e-6; step *= 0.5) {
      SmallVector<N> next = m;
      for (std::size_t a = 0; a < N; ++a) next[a] += step * direction[a];
      if (impl::dual<N>(rows, g, d, next, nullptr, nullptr) > value + 1e-4 * step * slope) continue;
      m = next;
      break;
    }
  }
  return m;
}

}  // namespace shoal::diffusion
