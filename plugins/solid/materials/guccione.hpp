// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Passive heart muscle (Guccione, McCulloch, Waldman 1991), transversely isotropic, with the volume apart:
//   W = c/2 (exp Q - 1) + K/4 (J^2 - 1 - 2 ln J)
//   Q = b_f E_ff^2 + b_t (E_ss^2 + E_nn^2 + 2 E_sn^2) + 2 b_fs (E_fs^2 + E_fn^2),   E = (J^(-2/3) C - I) / 2
// which needs the fibre f alone:  Q = b_t E : E + (b_f + b_t - 2 b_fs) (f.E f)^2 + 2 (b_fs - b_t) |E f|^2.
//   T = dW/dE = c/2 exp Q dQ/dE,   P = J^(-2/3) (F T - (T : C)/3 F^-T) + K/2 (J^2 - 1) F^-T
#pragma once

#include "shoal/pack_math.hpp"
#include "shoal/stress_law.hpp"
#include "tensors.hpp"

namespace shoal::solid {

class Guccione final : public StressLaw {
 public:
  Param<double> density{"density", "kg/m3", "Density of the undeformed tissue.", positive, example("1060")};
  Param<double> c{"c", "Pa", "Stiffness.", positive, example("10 kPa")};
  Param<double> b_f{"b_f", "1", "Exponent along the fibres.", positive, example("8")};
  Param<double> b_t{"b_t", "1", "Exponent across the fibres.", positive, example("2")};
  Param<double> b_fs{"b_fs", "1", "Exponent of shear along the fibres.", positive, example("4")};
  Param<double> bulk{"bulk_modulus", "Pa", "Bulk modulus, which keeps the volume.", positive,
                     example("1 MPa")};
  Param<VectorExpression> fibre{"fibre", "1", "Direction of the fibres; without it the field of that name.",
                                optional, example("[1, 0, 0]")};

  double reference_density() const override { return density; }
  double bulk_modulus() const override { return bulk; }
  // The mean of shear along (c b_fs / 2) and across (c b_t / 2) the fibres.
  double shear_modulus() const override { return 0.25 * c * (b_fs + b_t); }

  Tensor stress(const Tensor& F, LawPoint& point) const override {
    const auto [J, back] = invert(F);
    const Tensor C = right_cauchy_green(F);
    const Pack shape = isochoric_factor(J);
    const Vec<3, Pack> f = point(fibre_);
    const Tensor E = strain(shape, C);
    const Vec<3, Pack> Ef = E * f;
    const Pack E_ff = dot(f, Ef);
    const Tensor mixed = outer(Ef, f);
    const Tensor dQ = (2.0 * b_t) * E + (2.0 * along() * E_ff) * outer(f, f) +
                      (2.0 * (b_fs - b_t)) * (mixed + transpose(mixed));
    const Tensor T = (0.5 * c * fast_exp(exponent(E, Ef, E_ff))) * dQ;
    return shape * (F * T) + (volumetric_kirchhoff(bulk, J) - shape * double_dot(T, C) / 3.0) * back;
  }
  Pack energy(const Tensor& F, LawPoint& point) const override {
    const Pack J = determinant(F);
    const Vec<3, Pack> f = point(fibre_);
    const Tensor E = strain(isochoric_factor(J), right_cauchy_green(F));
    const Vec<3, Pack> Ef = E * f;
    return 0.5 * c * (fast_exp(exponent(E, Ef, dot(f, Ef))) - 1.0) + volumetric_energy(bulk, J);
  }
  bool keeps_volume_apart() const override { return true; }
  Pack volumetric_pressure(Pack J) const override { return pressure_of_split_law(bulk, J); }
  bool stiffens() const override { return true; }

 private:
  double along() const { return b_f + b_t - 2.0 * b_fs; }
  static Tensor strain(Pack shape, const Tensor& C) { return 0.5 * (shape * C - identity<3, Pack>()); }
  Pack exponent(const Tensor& E, const Vec<3, Pack>& Ef, Pack E_ff) const {
    return b_t.value() * double_dot(E, E) + along() * E_ff * E_ff + 2.0 * (b_fs - b_t) * squared_norm(Ef);
  }

  LawDirection fibre_{*this, "fibre", fibre};
};

}  // namespace shoal::solid
