// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Neo-Hookean rubber in two forms:
//   split    W = mu/2 (J^(-2/3) tr C - 3) + K/4 (J^2 - 1 - 2 ln J)
//            P = mu J^(-2/3) (F - tr C / 3 F^-T) + K/2 (J^2 - 1) F^-T
//   coupled  W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2
//            P = mu (F - F^-T) + lambda ln J F^-T
// The split form keeps volume and shape apart (Simo, Taylor 1982), as nearly incompressible materials need; the
// coupled one is that of Bonet and Wood 2008. Both are linear elasticity with E and nu for small strains.
#pragma once

#include "isotropic.hpp"

namespace shoal::solid {

class NeoHookean final : public IsotropicLaw {
 public:
  Param<Choice> form{
      "form", nullptr,
      "split: shape and volume apart, for any Poisson's ratio. coupled: mu/2 (tr C - 3) - mu ln J + "
      "lambda/2 (ln J)^2.",
      one_of("split", "coupled"), default_to("split")};

  Tensor stress(const Tensor& F, LawPoint&) const override {
    const auto [J, back] = invert(F);
    if (coupled()) return mu() * F + (lambda() * fast_log(J) - mu()) * back;
    const Pack shape = mu() * isochoric_factor(J);
    return shape * F + (volumetric_kirchhoff(bulk_modulus(), J) - shape * double_dot(F, F) / 3.0) * back;
  }
  Pack energy(const Tensor& F, LawPoint&) const override {
    const Pack J = determinant(F), trace_C = double_dot(F, F);
    if (coupled()) {
      const Pack ln_J = fast_log(J);
      return 0.5 * mu() * (trace_C - 3.0) - mu() * ln_J + 0.5 * lambda() * ln_J * ln_J;
    }
    return 0.5 * mu() * (isochoric_factor(J) * trace_C - 3.0) + volumetric_energy(bulk_modulus(), J);
  }
  bool keeps_volume_apart() const override { return !coupled(); }
  Pack volumetric_pressure(Pack J) const override { return pressure_of_split_law(bulk_modulus(), J); }
  bool stiffens() const override { return true; }

 private:
  bool coupled() const { return form.value() == "coupled"; }
};

}  // namespace shoal::solid
