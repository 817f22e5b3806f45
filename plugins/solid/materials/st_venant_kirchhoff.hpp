// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// St. Venant-Kirchhoff: linear in Green's strain E = (C - I) / 2,
//   W = lambda/2 (tr E)^2 + mu E : E,   S = lambda (tr E) I + 2 mu E,   P = F S.
// For large rotations with small strains. In compression it softens, and it gives way at a stretch of 1/sqrt(3).
#pragma once

#include "isotropic.hpp"

namespace shoal::solid {

class StVenantKirchhoff final : public IsotropicLaw {
 public:
  Tensor stress(const Tensor& F, LawPoint&) const override {
    const Tensor E = strain(F);
    Tensor S = (2.0 * mu()) * E;
    for (int k = 0; k < 3; ++k) S(k, k) += lambda() * trace(E);
    return F * S;
  }
  Pack energy(const Tensor& F, LawPoint&) const override {
    const Tensor E = strain(F);
    return 0.5 * lambda() * trace(E) * trace(E) + mu() * double_dot(E, E);
  }
  bool stiffens() const override { return true; }
  // For a wave along N with amplitude a, both of length 1, it is
  //   N.S N + lambda (a.F N)^2 + mu (|F^T a|^2 + (a.F N)^2) <= max(S) + (lambda + 2 mu) c,  c the largest stretch squared.
  // c is bounded by the mean of C and its deviator, a few hundredths of the strain too high.
  Pack wave_modulus(std::uint32_t kinematics, const Tensor& F, LawPoint& point) const override {
    if (kinematics == SHOAL_PLANE_STRESS) return IsotropicLaw::wave_modulus(kinematics, F, point);
    const Tensor C = right_cauchy_green(F);
    const Pack mean = trace(C) / 3.0;
    const Pack c = mean + sqrt(max(Pack(0.0), (2.0 / 3.0) * (double_dot(C, C) - 3.0 * mean * mean)));
    const Pack largest_stress = lambda() * 1.5 * (mean - 1.0) + mu() * (c - 1.0);
    return max(Pack(0.0), largest_stress) + (lambda() + 2.0 * mu()) * c;
  }

 private:
  static Tensor strain(const Tensor& F) { return 0.5 * (right_cauchy_green(F) - identity<3, Pack>()); }
};

}  // namespace shoal::solid
