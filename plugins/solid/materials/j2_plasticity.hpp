// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Metal plasticity with von Mises' yield condition and associated flow for large strains (Weber, Anand 1990; Simo 1992).
//   elastic  W = mu/2 (tr b - 3) + K/4 (J^2 - 1 - 2 ln J),   b = J^(-2/3) F G F^T,   G = Cp^-1, det G = 1
//            tau = s + K/2 (J^2 - 1) I,   s = mu dev b,   P = tau F^-T
//   yields   |s| = sqrt(2/3) sigma_y(alpha), alpha the equivalent plastic strain
//   flows    b = exp(-2 dgamma n) b_trial,   alpha = alpha_old + sqrt(2/3) dgamma,   n = s_trial / |s_trial|
// The trial state is that of the old G. As n has no trace, flow keeps the volume to rounding; it shares its axes with
// b, so that by n^3 = n/2 + det(n) I all of this is a polynomial in n, and dgamma the root of one equation. First order
// in the step. (The closed form of Simo 1988 leaves (dev b) n out of the flow: 0.3 % of the strain at sigma_y = E/500.)
// State: plastic_metric G and equivalent_plastic_strain alpha.
#pragma once

#include "isotropic.hpp"

namespace shoal::solid {

class J2Plasticity : public IsotropicLaw {
 public:
  Tensor stress(const Tensor& F, LawPoint& point) const final;
  Pack energy(const Tensor& F, LawPoint& point) const final {
    // Of the state that the stress of this F belongs to.
    const Pack J = determinant(F);
    const Tensor b = isochoric_factor(J) * (F * returned(F, point).metric * transpose(F));
    return 0.5 * mu() * (trace(b) - 3.0) + volumetric_energy(bulk_modulus(), J);
  }
  bool keeps_volume_apart() const final { return true; }
  Pack volumetric_pressure(Pack J) const final { return pressure_of_split_law(bulk_modulus(), J); }
  bool stiffens() const final { return true; }
  // Of elastic waves: those of unloading are the fastest. Their modulus along a deformed length is J^2 U'' + 4/3 mu =
  // K/2 (J^2 + 1) + 4/3 mu, the elastic shear being small; a length of the reference configuration is shorter by at
  // most |F^-1|, bounded here by tr((F^T F)^-8)^(1/16), which is at most 7 % more.
  Pack wave_modulus(std::uint32_t, const Tensor& F, LawPoint&) const final {
    const auto [J, back] = invert(F);
    Tensor power = transpose(back) * back;
    const Pack scale = trace(power);
    power = (1.0 / scale) * power;
    for (int k = 0; k < 3; ++k) power = power * power;
    return (0.5 * bulk_modulus() * (J * J + 1.0) + 4.0 / 3.0 * mu()) * scale * sqrt(sqrt(sqrt(trace(power))));
  }

 protected:
  struct YieldStress {
    Pack value;  // Pa
    Pack slope;  // d sigma_y / d alpha
  };
  // At alpha = before + increment.
  virtual YieldStress yield_stress(Pack before, Pack increment, LawPoint& point) const = 0;
  // After the return, for laws with more state. The stress that was worked against and the increment of alpha.
  virtual void flowed(Pack /*stress*/, Pack /*increment*/, LawPoint&) const {}

 private:
  struct Returned {
    Pack J;
    Tensor deviator;  // s
    Tensor metric;    // G
    Tensor inverse_transpose;
  };
  // b_trial = mean I + size n, det = det n.
  struct Trial {
    Pack mean, size, det;
  };
  struct Polynomial {
    Pack c0, c1, c2;
  };
  Returned returned(const Tensor& F, LawPoint& point) const;
  Pack flow_increment(const Trial& trial, Pack alpha, Mask yields, LawPoint& point) const;
  static Polynomial flowed_by(Pack x, const Trial& trial);

  LawTensor metric_{*this, "plastic_metric", "1", "Inverse of the plastic right Cauchy-Green tensor."};
  LawScalar alpha_{*this, "equivalent_plastic_strain", "1", "Equivalent plastic strain.", 0.0};
};

inline Tensor J2Plasticity::stress(const Tensor& F, LawPoint& point) const {
  const Returned r = returned(F, point);
  Tensor kirchhoff = r.deviator;
  for (int k = 0; k < 3; ++k) kirchhoff(k, k) += volumetric_kirchhoff(bulk_modulus(), r.J);
  return kirchhoff * r.inverse_transpose;
}

// exp(-2 x n) (mean I + size n) = c0 I + c1 n + c2 n^2, by the series of the exponential.
inline J2Plasticity::Polynomial J2Plasticity::flowed_by(Pack x, const Trial& trial) {
  const Pack y = -2.0 * x;
  Pack a = 1.0, b = 0.0, c = 0.0, sum_a = a, sum_b = b, sum_c = c;
  // A lane whose terms have faded gets no more of them, so that no particle depends on its company.
  Mask fading = true;
  for (int k = 1; k <= 20; ++k) {
    fading = fading & (abs(a) + abs(b) + abs(c) > 1e-20);
    if (none(fading)) break;
    const Pack factor = select(fading, y * (1.0 / k), Pack(0.0));
    const Pack next_a = factor * c * trial.det, next_b = factor * (a + 0.5 * c);
    c = factor * b, a = next_a, b = next_b;
    sum_a += a, sum_b += b, sum_c += c;
  }
  return {sum_a * trial.mean + sum_c * trial.size * trial.det,
          sum_b * trial.mean + (sum_a + 0.5 * sum_c) * trial.size, sum_c * trial.mean + sum_b * trial.size};
}

inline J2Plasticity::Returned J2Plasticity::returned(const Tensor& F, LawPoint& point) const {
  const auto [J, back] = invert(F);
  const Tensor old_metric = point(metric_);
  const Pack alpha = point(alpha_), shape = isochoric_factor(J), root = std::sqrt(2.0 / 3.0);
  Tensor b = shape * (F * old_metric * transpose(F));
  Trial trial{};
  trial.mean = trace(b) / 3.0;
  Tensor n = b;
  for (int k = 0; k < 3; ++k) n(k, k) -= trial.mean;
  Returned result{J, mu() * n, old_metric, back};
  trial.size = sqrt(double_dot(n, n));
  const Mask yields = mu() * trial.size > root * yield_stress(alpha, 0.0, point).value;
  Pack flow = 0.0;
  if (any(yields)) {
    n = (1.0 / max(Pack(1e-300), trial.size)) * n;
    trial.det = determinant(n);
    flow = flow_increment(trial, alpha, yields, point);
    const Polynomial c = flowed_by(flow, trial);
    const Tensor squared = n * n;
    b = c.c1 * n + c.c2 * squared;
    Tensor deviator = b;
    for (int k = 0; k < 3; ++k) {
      deviator(k, k) -= c.c2 / 3.0;  // tr n^2 = 1
      b(k, k) += c.c0;
    }
    result.deviator = select(yields, mu() * deviator, result.deviator);
    result.metric = select(yields, (1.0 / shape) * (transpose(back) * b * back), old_metric);
  }
  const Pack increment = root * flow;
  point.set(metric_, result.metric);
  point.set(alpha_, alpha + increment);
  flowed(yield_stress(alpha, increment, point).value, increment, point);
  return result;
}

// The root of g(x) = mu |dev b(x)| - sqrt(2/3) sigma_y(alpha + sqrt(2/3) x) by Newton's rule, kept inside a bracket.
// It begins where hardening would be nil. Lanes that have arrived stay, so that no particle depends on its company.
inline Pack J2Plasticity::flow_increment(const Trial& trial, Pack alpha, Mask yields, LawPoint& point) const {
  const double root = std::sqrt(2.0 / 3.0);
  const Pack start = mu() * trial.size - root * yield_stress(alpha, 0.0, point).value;
  Pack x = start / (2.0 * mu() * trial.mean), low = 0.0, high = 4.0 * x;
  Mask done = !yields;
  for (int k = 0; k < 80 && !all(done); ++k) {
    const Polynomial c = flowed_by(x, trial);
    const Pack d1 = -2.0 * c.c0 - c.c2, d2 = -2.0 * c.c1;  // d/dx, from db/dx = -2 n b
    const Pack size = sqrt(c.c1 * c.c1 + 6.0 * trial.det * c.c1 * c.c2 + c.c2 * c.c2 / 6.0);
    const Pack slope = (c.c1 * d1 + 3.0 * trial.det * (d1 * c.c2 + c.c1 * d2) + c.c2 * d2 / 6.0) / size;
    const YieldStress now = yield_stress(alpha, root * x, point);
    const Pack g = mu() * size - root * now.value;
    low = select(g > 0.0, x, low);
    high = select(g > 0.0, high, x);
    done = done | (abs(g) <= 1e-14 * mu() * trial.size) | (high - low <= 2e-16 * high);
    const Pack newton = x - g / (mu() * slope - (2.0 / 3.0) * now.slope);
    const Mask inside = (newton > low) & (newton < high);
    x = select(done, x, select(inside, newton, 0.5 * (low + high)));
  }
  return select(yields, x, Pack(0.0));
}

}  // namespace shoal::solid
