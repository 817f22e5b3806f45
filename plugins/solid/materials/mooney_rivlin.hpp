// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Mooney-Rivlin rubber (Mooney 1940, Rivlin 1948), with the volume apart:
//   W = c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3) + K/4 (J^2 - 1 - 2 ln J),   I1 = tr C, I2 = (I1^2 - C : C) / 2
//   P = 2 c1 J^(-2/3) (F - I1/3 F^-T) + 2 c2 J^(-4/3) (I1 F - F C - 2/3 I2 F^-T) + K/2 (J^2 - 1) F^-T
// mu = 2 (c1 + c2) for small strains.
#pragma once

#include "shoal/stress_law.hpp"
#include "tensors.hpp"

namespace shoal::solid {

class MooneyRivlin final : public StressLaw {
 public:
  Param<double> density{"density", "kg/m3", "Density of the undeformed material.", positive, example("1100")};
  Param<double> c1{"c1", "Pa", "Coefficient of the first invariant.", non_negative, example("0.3 MPa")};
  Param<double> c2{"c2", "Pa", "Coefficient of the second invariant.", non_negative, example("0.05 MPa")};
  Param<double> bulk{"bulk_modulus", "Pa", "Bulk modulus.", positive, example("50 MPa")};

  void check() override {
    if (c1 + c2 == 0.0)
      throw CaseError(c1.place() + ": c1 and c2 are both zero, so nothing resists a change of shape");
  }
  double reference_density() const override { return density; }
  double bulk_modulus() const override { return bulk; }
  double shear_modulus() const override { return 2.0 * (c1 + c2); }

  Tensor stress(const Tensor& F, LawPoint&) const override {
    const auto [J, back] = invert(F);
    const Tensor C = right_cauchy_green(F);
    const Pack I1 = trace(C), I2 = 0.5 * (I1 * I1 - double_dot(C, C)), f = isochoric_factor(J);
    const Pack first = (2.0 * c1) * f, second = (2.0 * c2) * f * f;
    return (first + second * I1) * F - second * (F * C) +
           (volumetric_kirchhoff(bulk, J) - first * I1 / 3.0 - second * I2 * (2.0 / 3.0)) * back;
  }
  Pack energy(const Tensor& F, LawPoint&) const override {
    const Pack J = determinant(F), f = isochoric_factor(J);
    const Tensor C = right_cauchy_green(F);
    const Pack I1 = trace(C), I2 = 0.5 * (I1 * I1 - double_dot(C, C));
    return c1.value() * (f * I1 - 3.0) + c2.value() * (f * f * I2 - 3.0) + volumetric_energy(bulk, J);
  }
  bool keeps_volume_apart() const override { return true; }
  Pack volumetric_pressure(Pack J) const override { return pressure_of_split_law(bulk, J); }
  bool stiffens() const override { return true; }
};

}  // namespace shoal::solid
