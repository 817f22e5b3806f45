// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The quadratic least-squares fit of a flow's fields at the midpoint of an advection step, and what is made of it:
//   grad f = sum_j (f_j - f_i) g_ij,    lap f = sum_j (f_j - f_i) l_ij                    (shoal/fit.hpp)
// with the Wendland C2 weight of radius 2h: on particles that are not in order it averages more than a narrower weight,
// and what it smooths the correction of the Laplacian (viscosity.hpp) puts back.
//
// In the same pass the shift that keeps particles evenly spread (Lind et al. 2012; Adami, Hu, Adams 2013):
//   dr_i = -C h^2 dx^D sum_j grad W_ij,   |dr_i| <= 0.05 dx
#pragma once

#include <cmath>

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"

namespace shoal::fluid::least_squares {

inline constexpr const char *gradient_doc = "Gradient rows of the fit.",
                            *laplacian_doc = "Laplacian row of the fit.",
                            *shift_doc = "Shift of the particle in an advection step.";

template <int D>
using Weight = WendlandC2<D>;

// The shift, not longer than `limit`.
template <int D>
Vec<D> limited(const Vec<D>& shift, double limit) {
  const double length = norm(shift);
  return (length > limit ? limit / length : 1.0) * shift;
}

struct Fit : PairOperator<Fit> {
  template <int D>
  using Kernel = Weight<D>;

  Out<FitGradient> gradient{"fit_gradient", unit("1"), doc(gradient_doc), derived};
  Out<FitLaplacian> laplacian{"fit_laplacian", unit("1"), doc(laplacian_doc), derived};
  Out<Vector> next_shift{"next_shift", unit("m"), doc(shift_doc), derived};

  double shift_strength = 0.5;
  double largest_shift = 0.05;  // over dx

  auto pair(const auto& p) const {
    using P = std::decay_t<decltype(p)>;
    constexpr int D = P::dimensions, N = fit_terms<D>;
    const auto q = fit_monomials((-1.0 / p.h()) * p.r_ij());
    const auto w = p.W();
    Vec<fit::moments<D>, typename P::RealType> m{};
    for (int r = 0, k = 0; r < N; ++r) {
      const auto wq = w * q[r];
      for (int c = r; c < N; ++c) m[k++] = wq * q[c];
    }
    return sums(m, p.grad_W());
  }
  void particle(auto i, const auto& moments, auto crowding) const {
    constexpr int D = decltype(i)::dimensions;
    const auto all = fit::derivatives<D>(moments, smoothing_length(), 0.0);
    fit::keep<FitGradient, D>(all, gradient[i]);
    fit::keep<FitLaplacian, D>(all, laplacian[i]);
    const double h = smoothing_length(), dx = spacing();
    next_shift[i] =
        limited((-shift_strength * h * h * (D == 2 ? dx * dx : dx * dx * dx)) * crowding, largest_shift * dx);
  }
};

}  // namespace shoal::fluid::least_squares
