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

 private:
  static Tensor strain(const Tensor& F) { return 0.5 * (right_cauchy_green(F) - identity<3, Pack>()); }
};

}  // namespace shoal::solid
