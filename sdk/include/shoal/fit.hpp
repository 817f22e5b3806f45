// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Derivatives by a quadratic weighted least-squares fit (Liszka and Orkisz 1980; as second-order moving least squares
// in particle methods). Around particle i a field is taken as
//   f_j - f_i = c . p(x_j - x_i),   p(d) = (d_a / h, ..., d_a d_b / h^2, ...),  a <= b,
// and c minimises sum_j W_ij (f_j - f_i - c . p_ij)^2. With the moments M_i = sum_j W_ij p_ij p_ij^T,
//   c = M_i^-1 sum_j W_ij p_ij (f_j - f_i),
// so that every derivative is a sum over neighbours of (f_j - f_i) times a weight that depends on the geometry alone:
//   grad f = sum_j (f_j - f_i) g_ij,   lap f = sum_j (f_j - f_i) l_ij.
// Gradients are exact for quadratic fields, second derivatives too; on disordered particles and at free surfaces no
// less than inside. The Bonet-Lok correction is the same with the linear monomials alone.
//
// An operator `QuadraticFit` solves the moments of each particle and writes rows of M^-1, scaled so that the weights
// are derivatives per metre; pair code of other operators makes the weights from them:
//
//     struct Gradient : PairOperator<Gradient> {
//       template <int D> using Kernel = FitKernel<D>;           // the same weight as the fit, and the same h
//       static constexpr bool row_by_row = true;                // p.i(fit) are numbers of one particle
//       In<FitGradient> fit{"fit", unit("1"), doc("..."), own_only};
//       auto pair(const auto& p) const { return (p.j(f) - p.i(f)) * fit_gradient(p, p.i(fit)); }
//
// Numbers a particle: gradient 10 in 2D, 27 in 3D; Laplacian 5, 9; all derivatives 25, 81.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "shoal/pair_operator.hpp"

namespace shoal {

// Number of monomials: D linear ones, then D (D + 1) / 2 quadratic ones in the order xx, xy, (xz,) yy, (yz, zz).
template <int D>
inline constexpr int fit_terms = D + D*(D + 1) / 2;

// Rows of the inverse that are kept for each particle.
using FitGradient = Array<2 * 5, 3 * 9>;  // d/dx, d/dy, d/dz
using FitLaplacian = Array<5, 9>;
using FitDerivatives = Array<5 * 5, 9 * 9>;  // d/dx, ..., d2/dx2, d2/dxdy, ... in the order of the monomials

inline namespace SHOAL_ISA_NAMESPACE {

// The weight of the fit: narrow, so that near neighbours count (measured on the Taylor-Green vortex: half the error of
// Wendland C2). The smoothing length is that of the target.
template <int D>
using FitKernel = WendlandC6<D>;

// The monomials of d / h.
template <int D, class R>
Vec<fit_terms<D>, R> fit_monomials(const Vec<D, R>& d) {
  Vec<fit_terms<D>, R> p;
  int k = D;
  for (int a = 0; a < D; ++a) {
    p[a] = d[a];
    for (int b = a; b < D; ++b) p[k++] = d[a] * d[b];
  }
  return p;
}

namespace fit {

template <int D>
inline constexpr int moments = fit_terms<D>*(fit_terms<D> + 1) / 2;

// W_ij p_ij of a pair.
template <class P>
auto weighted_monomials(const P& p) {
  auto q = fit_monomials((-1.0 / p.h()) * p.r_ij());
  const auto w = p.W();
  for (auto& component : q.e) component *= w;
  return q;
}

// Inverts the leading n x n block of the symmetric positive matrix m (row by row, stride N) by Cholesky factorisation.
// Returns false, and leaves `inverse` as it is, if the matrix is singular to eight digits of its diagonal.
template <int N>
bool invert(const std::array<double, N * N>& m, int n, std::array<double, N * N>& inverse) {
  std::array<double, N * N> l{};
  const auto at = [](int row, int column) { return static_cast<std::size_t>(row * N + column); };
  for (int c = 0; c < n; ++c) {
    double pivot = m[at(c, c)];
    for (int k = 0; k < c; ++k) pivot -= l[at(c, k)] * l[at(c, k)];
    if (!(pivot > 1e-8 * m[at(c, c)])) return false;
    const double root = std::sqrt(pivot);
    l[at(c, c)] = root;
    for (int r = c + 1; r < n; ++r) {
      double value = m[at(r, c)];
      for (int k = 0; k < c; ++k) value -= l[at(r, k)] * l[at(c, k)];
      l[at(r, c)] = value / root;
    }
  }
  for (int column = 0; column < n; ++column) {
    std::array<double, N> x{};
    for (int r = column; r < n; ++r) {  // L y = e
      double value = r == column ? 1.0 : 0.0;
      for (int k = column; k < r; ++k) value -= l[at(r, k)] * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(r)] = value / l[at(r, r)];
    }
    for (int r = n - 1; r >= 0; --r) {  // L^T x = y
      double value = x[static_cast<std::size_t>(r)];
      for (int k = r + 1; k < n; ++k) value -= l[at(k, r)] * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(r)] = value / l[at(r, r)];
    }
    for (int r = 0; r < n; ++r) inverse[at(r, column)] = x[static_cast<std::size_t>(r)];
  }
  return true;
}

// The inverse of the moments, each row scaled to a derivative per metre. `eps` times the sum of the linear diagonal is
// added to the diagonal of the quadratic terms: linear fields stay exact, and stiff weights on disordered particles
// lose their peaks. Where the quadratic fit has too few neighbours the linear one is taken and second derivatives are
// zero; where that has too few, all are zero.
template <int D>
std::array<double, fit_terms<D> * fit_terms<D>> derivatives(const Vec<moments<D>>& sums, double h,
                                                            double eps) {
  constexpr int N = fit_terms<D>;
  std::array<double, N * N> m{}, inverse{};
  int k = 0;
  for (int r = 0; r < N; ++r)
    for (int c = r; c < N; ++c, ++k)
      m[static_cast<std::size_t>(r * N + c)] = m[static_cast<std::size_t>(c * N + r)] = sums[k];
  double linear = 0;
  for (int a = 0; a < D; ++a) linear += m[static_cast<std::size_t>(a * (N + 1))];
  for (int r = D; r < N; ++r) m[static_cast<std::size_t>(r * (N + 1))] += eps * linear;
  if (!invert<N>(m, N, inverse)) invert<N>(m, D, inverse);
  int row = D;
  for (int a = 0; a < D; ++a) {
    for (int c = 0; c < N; ++c) inverse[static_cast<std::size_t>(a * N + c)] *= 1.0 / h;
    for (int b = a; b < D; ++b, ++row)
      for (int c = 0; c < N; ++c)
        inverse[static_cast<std::size_t>(row * N + c)] *= (a == b ? 2.0 : 1.0) / (h * h);
  }
  return inverse;
}

template <class Rows, int D>
void keep(const std::array<double, fit_terms<D> * fit_terms<D>>& all,
          typename impl::Element<Rows, D>::type& rows) {
  constexpr std::size_t N = fit_terms<D>;
  if constexpr (std::is_same_v<Rows, FitLaplacian>) {
    rows.fill(0.0);
    std::size_t row = D;
    for (int a = 0; a < D; row += static_cast<std::size_t>(D - a), ++a)  // xx, yy, zz
      for (std::size_t c = 0; c < N; ++c) rows[c] += all[row * N + c];
  } else {
    std::copy_n(all.begin(), rows.size(), rows.begin());
  }
}

}  // namespace fit

// Weight of (f_j - f_i) in the gradient, 1/m.
template <class P, std::size_t Numbers>
auto fit_gradient(const P& p, const std::array<double, Numbers>& rows) {
  constexpr int D = P::dimensions, N = fit_terms<D>;
  static_assert(Numbers >= D * N, "the gradient needs rows of FitGradient or FitDerivatives");
  const auto q = fit::weighted_monomials(p);
  Vec<D, typename P::RealType> g{};
  for (int a = 0; a < D; ++a)
    for (int c = 0; c < N; ++c) g[a] += rows[static_cast<std::size_t>(a * N + c)] * q[c];
  return g;
}

// Weight of (f_j - f_i) in the Laplacian, 1/m2.
template <class P>
auto fit_laplacian(const P& p,
                   const std::array<double, static_cast<std::size_t>(fit_terms<P::dimensions>)>& row) {
  const auto q = fit::weighted_monomials(p);
  typename P::RealType l = 0.0;
  for (int c = 0; c < fit_terms<P::dimensions>; ++c) l += row[static_cast<std::size_t>(c)] * q[c];
  return l;
}

// Weights of (f_j - f_i) in all first and second derivatives, in the order of the monomials, 1/m and 1/m2.
template <class P>
auto fit_derivatives(
    const P& p,
    const std::array<double, static_cast<std::size_t>(fit_terms<P::dimensions>* fit_terms<P::dimensions>)>&
        rows) {
  constexpr int N = fit_terms<P::dimensions>;
  const auto q = fit::weighted_monomials(p);
  Vec<N, typename P::RealType> weights{};
  for (int r = 0; r < N; ++r)
    for (int c = 0; c < N; ++c) weights[r] += rows[static_cast<std::size_t>(r * N + c)] * q[c];
  return weights;
}

namespace fit {

template <class Derived, class Rows, template <int> class Weight>
struct Solver : PairOperator<Derived> {
  template <int D>
  using Kernel = Weight<D>;

  Out<Rows> rows{"fit", unit("1"), doc("Rows of the inverse moments of a quadratic least-squares fit.")};
  double eps = 0.0;  // regularisation of the quadratic terms

  auto pair(const auto& p) const {
    constexpr int D = std::decay_t<decltype(p)>::dimensions, N = fit_terms<D>;
    const auto q = fit_monomials((-1.0 / p.h()) * p.r_ij());
    const auto w = p.W();
    Vec<moments<D>, typename std::decay_t<decltype(p)>::RealType> m{};
    for (int r = 0, k = 0; r < N; ++r) {
      const auto wq = w * q[r];
      for (int c = r; c < N; ++c) m[k++] = wq * q[c];
    }
    return m;
  }
  void particle(auto i, const auto& sums) const {
    constexpr int D = decltype(i)::dimensions;
    keep<Rows, D>(derivatives<D>(sums, this->smoothing_length(), eps), rows[i]);
  }
};

}  // namespace fit

// Solves the moments over all neighbours of the target and writes the rows of type Rows to the field `fit` (rename it
// where a body has several). The field is state, so that what is built once survives a restart; apply(derived) where
// it is made anew in each step. Operators that make weights from the rows use the same smoothing kernel `Weight`
// with the same smoothing length.
template <class Rows, template <int> class Weight = FitKernel>
struct QuadraticFit : fit::Solver<QuadraticFit<Rows, Weight>, Rows, Weight> {};

// The same with distances in the reference configuration.
template <class Rows, template <int> class Weight = FitKernel>
struct ReferenceQuadraticFit : fit::Solver<ReferenceQuadraticFit<Rows, Weight>, Rows, Weight> {
  static constexpr const char* pair_geometry = "reference_position";
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
