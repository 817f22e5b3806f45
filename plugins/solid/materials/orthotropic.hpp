// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Orthotropic St. Venant-Kirchhoff material: linear in Green's strain E, with axes 1 = fibre, 2 = sheet, 3 = across
// both, in the reference configuration.
//   W = 1/2 E : D E,   S = D E,   P = F S
//   inverse of D:  E_11 = S_11/E1 - nu12 S_22/E1 - nu13 S_33/E1, ..., nu_ij / E_i = nu_ji / E_j;   E_ij = S_ij / (2 G_ij)
#pragma once

#include <array>
#include <vector>

#include "shoal/stress_law.hpp"
#include "tensors.hpp"

namespace shoal::solid {

class Orthotropic final : public StressLaw {
 public:
  Param<double> density{"density", "kg/m3", "Density of the undeformed material.", positive, example("700")};
  Param<std::vector<double>> youngs_moduli{"youngs_moduli", "Pa",
                                           "Young's moduli along fibre, sheet and across both.", positive,
                                           example("[12 GPa, 0.9 GPa, 0.5 GPa]")};
  Param<std::vector<double>> poisson_ratios{
      "poisson_ratios", "1",
      "nu12, nu23, nu13: contraction along the second axis when pulled along the first.",
      example("[0.4, 0.35, 0.45]")};
  Param<std::vector<double>> shear_moduli{"shear_moduli", "Pa", "G12, G23, G13.", positive,
                                          example("[0.9 GPa, 0.05 GPa, 0.7 GPa]")};
  Param<VectorExpression> fibre{"fibre", "1", "Direction of axis 1; without it the field of that name.",
                                optional, example("[1, 0, 0]")};
  Param<VectorExpression> sheet{"sheet", "1", "Direction of axis 2; without it the field of that name.",
                                optional, example("[0, 1, 0]")};

  void check() override;
  double reference_density() const override { return density; }
  // Of a sphere under pressure, and the mean of the three.
  double bulk_modulus() const override;
  double shear_modulus() const override {
    const auto& G = shear_moduli.value();
    return (G[0] + G[1] + G[2]) / 3.0;
  }

  Tensor stress(const Tensor& F, LawPoint& point) const override {
    const Tensor axes = axes_at(point);
    const Tensor E = strain(F, axes);
    return F * (transpose(axes) * stress_along(E) * axes);
  }
  Pack energy(const Tensor& F, LawPoint& point) const override {
    const Tensor E = strain(F, axes_at(point));
    return 0.5 * double_dot(E, stress_along(E));
  }
  bool stiffens() const override { return true; }

 private:
  // Rows are the axes.
  Tensor axes_at(const LawPoint& point) const {
    const Vec<3, Pack> f = point(fibre_), s = point(sheet_), n = cross(f, s);
    return {f[0], f[1], f[2], s[0], s[1], s[2], n[0], n[1], n[2]};
  }
  static Tensor strain(const Tensor& F, const Tensor& axes) {
    return axes * (0.5 * (right_cauchy_green(F) - identity<3, Pack>())) * transpose(axes);
  }
  Tensor stress_along(const Tensor& E) const {
    Tensor S{};
    for (int i = 0; i < 3; ++i) S(i, i) = D_(i, 0) * E(0, 0) + D_(i, 1) * E(1, 1) + D_(i, 2) * E(2, 2);
    const auto& G = shear_moduli.value();
    S(0, 1) = S(1, 0) = 2.0 * G[0] * E(0, 1);
    S(1, 2) = S(2, 1) = 2.0 * G[1] * E(1, 2);
    S(0, 2) = S(2, 0) = 2.0 * G[2] * E(0, 2);
    return S;
  }

  Mat<3> D_{};  // of the normal strains
  LawDirection fibre_{*this, "fibre", fibre};
  LawDirection sheet_{*this, "sheet", sheet, &fibre_};
};

inline void Orthotropic::check() {
  for (const auto* list : {&youngs_moduli, &poisson_ratios, &shear_moduli})
    if (list->value().size() != 3)
      throw CaseError(list->place() + ": expected three numbers, e.g. [12e9, 0.9e9, 0.5e9]");
  const auto& E = youngs_moduli.value();
  const auto& nu = poisson_ratios.value();
  const Mat<3> compliance{1.0 / E[0],    -nu[0] / E[0], -nu[2] / E[0], -nu[0] / E[0], 1.0 / E[1],
                          -nu[1] / E[1], -nu[2] / E[0], -nu[1] / E[1], 1.0 / E[2]};
  const double minor = compliance(0, 0) * compliance(1, 1) - compliance(0, 1) * compliance(1, 0);
  if (!(minor > 0.0) || !(determinant(compliance) > 0.0))
    throw CaseError(
        poisson_ratios.place() +
        ": with these Poisson's ratios the material would gain energy when deformed; they must satisfy "
        "nu12^2 < E1/E2, nu23^2 < E2/E3, nu13^2 < E1/E3 and be small enough together");
  D_ = inverse(compliance);
}

inline double Orthotropic::bulk_modulus() const {
  double sum = 0.0;
  for (int k = 0; k < 9; ++k) sum += D_[k];
  return sum / 9.0;
}

}  // namespace shoal::solid
