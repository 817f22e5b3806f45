// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The quadratic least-squares fit of a flow's fields at the midpoint of an advection step, and what is made of it:
//   grad f = sum_j (f_j - f_i) g_ij,    lap f = sum_j (f_j - f_i) l_ij                    (shoal/fit.hpp)
// with the Wendland C2 weight of radius 2h: on particles that are not in order it averages more than a narrower weight,
// and what it smooths the correction of the Laplacian (viscosity.hpp) puts back.
//
// In the same pass the shift that keeps particles evenly spread (Lind et al. 2012; Adami, Hu, Adams 2013):
//   dr_i = -C h^2 dx^D sum_j grad W_ij,   |dr_i| <= 0.1 dx
// A particle moves up to 0.3 dx in a step. With half the limit, voids that open in the corner of a driven cavity, where the
// flow leaves along the lid, were not filled in time: at Re 1000 the fits there got stiff and the run failed after 20 to 50 L/U.
//
// And how stiff the Laplacian is at the stiffest particle, which bounds the acoustic steps. By Cauchy and Schwarz, without
// a sum of its own,
//   sum_j |l_ij| <= sqrt(sum_j W_ij  sum_j l_ij^2 / W_ij),   sum_j l_ij^2 / W_ij = L.(M^-1 L)
// L being what the Laplacian makes of the monomials, 2/h^2 for each square.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"

#include "course.hpp"

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

// The bound on sum_j |l_ij| above, 1/m2, from the row of the Laplacian.
template <int D, class Row>
double laplacian_norm(double sum_of_weights, const Row& laplacian, double h) {
  double squares = 0;
  std::size_t k = D;
  for (int a = 0; a < D; k += static_cast<std::size_t>(D - a), ++a) squares += laplacian[k];  // xx, yy, zz
  return std::sqrt(std::max(0.0, sum_of_weights * squares * 2.0 / (h * h)));
}

struct Fit : PairOperator<Fit> {
  template <int D>
  using Kernel = Weight<D>;

  Out<FitGradient> gradient{"fit_gradient", unit("1"), doc(gradient_doc), derived};
  Out<FitLaplacian> laplacian{"fit_laplacian", unit("1"), doc(laplacian_doc), derived};
  Out<Vector> next_shift{"next_shift", unit("m"), doc(shift_doc), derived};

  double shift_strength = 0.5;
  double largest_shift = 0.1;  // over dx
  Maximum stiffest{};
  CoursePointer course;

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
    return sums(m, p.grad_W(), w);
  }
  void particle(auto i, const auto& moments, auto crowding, double weights) const {
    constexpr int D = decltype(i)::dimensions;
    const auto all = fit::derivatives<D>(moments, smoothing_length(), 0.0);
    fit::keep<FitGradient, D>(all, gradient[i]);
    fit::keep<FitLaplacian, D>(all, laplacian[i]);
    stiffest.update(i, laplacian_norm<D>(weights, laplacian[i], smoothing_length()));
    const double h = smoothing_length(), dx = spacing();
    next_shift[i] =
        limited((-shift_strength * h * h * (D == 2 ? dx * dx : dx * dx * dx)) * crowding, largest_shift * dx);
  }
  void end() { course->laplacian_norm = stiffest.result(); }
};

}  // namespace shoal::fluid::least_squares
