// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A filter of the velocity, in every second advection step. The limiter of the Riemann solver (riemann.hpp) leaves slow flow
// without dissipation, and particles that jitter about a smooth flow, even one at rest, never calm down. The filter
// takes away what differs from a linear flow over the neighbourhood,
//   v'_i = v_i - [mean + gradient (r_i - centre)],     least squares over i and its neighbours, weights V_j W_ij
//   dv_i = C h (rho0/rho_i) sum_j V_j [(v'_i - v'_j).e_ij] e_ij W'_ij
// Linear flow, rotation among it, passes untouched, at free surfaces and walls too; a smooth flow changes by
// C h^4 d^4 v / dx^4 only. Momentum and angular momentum are kept to rounding: what pairs exchange is opposite and
// central. The fastest mode shrinks by 1 - 2.33 C in 2D and 1 - 2 C in 3D each time: stable for C < 0.85. With C = 0.4
// 0.07 and 0.2 of it are left; errors are those of twice the passes with C = 0.3 (standing_wave, dam_break_2d, hydrostatic_2d).
#pragma once

#include <memory>
#include <tuple>

#include "intermittent.hpp"

namespace shoal::fluid {

// The upper triangle of v v, row by row.
template <int D, class R>
auto upper_square(const Vec<D, R>& v) {
  Vec<D*(D + 1) / 2, R> upper{};
  for (int a = 0, k = 0; a < D; ++a)
    for (int b = a; b < D; ++b) upper[k++] = v[a] * v[b];
  return upper;
}

// v'. Where neighbours do not span the space, e.g. in a spray, the gradient is damped towards zero.
struct VelocityFluctuation : IntermittentPairOperator<VelocityFluctuation> {
  static constexpr bool single_in_3d_only = true;

  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  Out<Vector> fluctuation{"velocity_fluctuation", unit("m/s"),
                          doc("Velocity less the linear flow over the neighbourhood."), derived};

  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(velocity); }
  auto pair(const auto& p) const {
    const auto w = p.j(volume) * p.W();
    const auto r = (1.0 / p.h()) * p.r_ij();
    const auto v = p.i(velocity) - p.j(velocity);
    return sums(w, w * r, w * v, w * upper_square(r), outer(w * v, r));
  }
  template <int D>
  void particle(Particle<D> i, double weight, Vec<D> r, Vec<D> v, Vec<D*(D + 1) / 2> rr, Mat<D> vr) const {
    const double scale = 1.0 / (weight + volume[i] * self_w_);
    const Vec<D> mean_r = scale * r, mean_v = scale * v;
    Mat<D> moment;
    for (int a = 0, k = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++k) moment(a, b) = moment(b, a) = scale * rr[k] - mean_r[a] * mean_r[b];
    for (int a = 0; a < D; ++a) moment(a, a) += 1e-6;
    const Mat<D> gradient = (scale * vr - outer(mean_v, mean_r)) * inverse(moment);
    fluctuation[i] = mean_v - gradient * mean_r;
  }
  void begin() { self_w_ = self_W(); }

 private:
  double self_w_ = 0;
};

struct VelocityFilter : IntermittentPairOperator<VelocityFilter> {
  static constexpr bool skips_lonely = true;
  static constexpr bool single_in_3d_only = true;

  In<Vector> fluctuation{"velocity_fluctuation", unit("m/s"),
                         doc("Velocity less the linear flow over the neighbourhood."), derived};
  In<Scalar> volume{"volume"};
  In<Scalar> density{"density", own_only};
  InOut<Vector> velocity{"velocity"};

  double strength = 0;           // C
  double reference_density = 0;  // kg/m3
  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(fluctuation); }
  auto pair(const auto& p) const {
    const auto along = dot(p.i(fluctuation) - p.j(fluctuation), p.r_ij());
    return (p.j(volume) * p.dW_over_r() * p.per_r() * along) * p.r_ij();
  }
  void particle(auto i, auto sum) const {
    velocity[i] += (strength * smoothing_length() * reference_density / density[i]) * sum;
  }
};

}  // namespace shoal::fluid
