// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Passive heart muscle (Holzapfel, Ogden 2009), compressible as in Zhang et al. 2021:
//   W = a/(2b) {exp[b (I1 - 3)] - 1} - a ln J + lambda/2 (ln J)^2
//     + sum_{i=f,s} a_i/(2 b_i) {exp[b_i (I_i - 1)^2] - 1} + a_fs/(2 b_fs) {exp[b_fs I_fs^2] - 1}
//   I1 = tr C, I_f = f.C f, I_s = s.C s, I_fs = f.C s;   f, s unit directions of fibres and sheets
//   P = F S,  S = a exp[b (I1 - 3)] I + (lambda ln J - a) C^-1 + sum_i 2 a_i (I_i - 1) exp[b_i (I_i - 1)^2] i (x) i
//     + a_fs I_fs exp[b_fs I_fs^2] (f (x) s + s (x) f)
// S is derived from W; the S that is printed in the second paper does not belong to its W.
// Undeformed: mu = a, K = lambda + 2 a b + 2/3 a, besides what the fibres add.
#pragma once

#include "shoal/pack_math.hpp"
#include "shoal/stress_law.hpp"
#include "tensors.hpp"

namespace shoal::solid {

class HolzapfelOgden final : public StressLaw {
 public:
  Param<double> density{"density", "kg/m3", "Density of the undeformed tissue.", positive, example("1060")};
  Param<double> bulk{"bulk_modulus", "Pa", "Bulk modulus of the undeformed tissue without its fibres.",
                     positive, example("450 kPa")};
  Param<double> a{"a", "Pa", "Stiffness of the ground substance: its shear modulus.", positive,
                  example("59 Pa")};
  Param<double> b{"b", "1", "Exponent of the ground substance.", positive, example("8.023")};
  Param<double> a_f{
      "a_f", "Pa", "Stiffness of the fibres.", non_negative, default_to(0.0), example("18.472 kPa")};
  Param<double> b_f{"b_f", "1", "Exponent of the fibres.", positive, default_to(1.0), example("16.026")};
  Param<double> a_s{"a_s",
                    "Pa",
                    "Stiffness across the fibres in the sheets.",
                    non_negative,
                    default_to(0.0),
                    example("2.481 kPa")};
  Param<double> b_s{"b_s", "1", "Exponent across the fibres.", positive, default_to(1.0), example("11.120")};
  Param<double> a_fs{"a_fs",
                     "Pa",
                     "Stiffness against shear between fibre and sheet.",
                     non_negative,
                     default_to(0.0),
                     example("216 Pa")};
  Param<double> b_fs{"b_fs", "1", "Exponent of that shear.", positive, default_to(1.0), example("11.436")};
  Param<bool> fibres_push{"fibres_push", nullptr,
                          "Whether fibres and sheets resist shortening too; real ones buckle.",
                          default_to(false)};
  Param<VectorExpression> fibre{"fibre", "1", "Direction of the fibres; without it the field of that name.",
                                optional, example("[1, 0, 0]")};
  Param<VectorExpression> sheet{"sheet", "1",
                                "Direction across the fibres in the sheets; without it the field of that "
                                "name.",
                                optional, example("[0, 1, 0]")};

  void check() override {
    if (!has_fibres()) fibre_.leave_out(), sheet_.leave_out();
    if (lambda() <= -2.0 / 3.0 * a)
      throw CaseError(bulk.place() +
                      ": bulk_modulus must be larger than 2 a b, which the ground substance adds");
  }
  double reference_density() const override { return density; }
  double bulk_modulus() const override { return bulk; }
  double shear_modulus() const override { return a; }
  double lambda() const { return bulk - 2.0 * a * b - 2.0 / 3.0 * a; }

  Tensor stress(const Tensor& F, LawPoint& point) const override {
    const auto [J, back] = invert(F);
    const Pack ground = a.value() * fast_exp(b.value() * (double_dot(F, F) - 3.0));
    Tensor P = ground * F + (lambda() * fast_log(J) - a.value()) * back;
    if (!has_fibres()) return P;
    const Vec<3, Pack> f = point(fibre_), s = point(sheet_), Ff = F * f, Fs = F * s;
    P += outer(along(a_f, b_f, squared_norm(Ff)) * Ff, f) + outer(along(a_s, b_s, squared_norm(Fs)) * Fs, s);
    if (a_fs > 0.0) {
      const Pack I_fs = dot(Ff, Fs);
      P += (a_fs.value() * I_fs * fast_exp(b_fs.value() * I_fs * I_fs)) * (outer(Ff, s) + outer(Fs, f));
    }
    return P;
  }
  Pack energy(const Tensor& F, LawPoint& point) const override {
    const Pack ln_J = fast_log(determinant(F));
    Pack W = 0.5 * a / b * (fast_exp(b.value() * (double_dot(F, F) - 3.0)) - 1.0) - a.value() * ln_J +
             0.5 * lambda() * ln_J * ln_J;
    if (!has_fibres()) return W;
    const Vec<3, Pack> Ff = F * point(fibre_), Fs = F * point(sheet_);
    const Pack I_fs = dot(Ff, Fs);
    W += energy_along(a_f, b_f, squared_norm(Ff)) + energy_along(a_s, b_s, squared_norm(Fs)) +
         0.5 * a_fs / b_fs * (fast_exp(b_fs.value() * I_fs * I_fs) - 1.0);
    return W;
  }
  bool stiffens() const override { return true; }

 private:
  bool has_fibres() const { return a_f > 0.0 || a_s > 0.0 || a_fs > 0.0; }
  // I - 1, or zero where a fibre is shortened.
  Pack pull(Pack I) const { return fibres_push ? I - 1.0 : max(Pack(0.0), I - 1.0); }
  Pack along(double stiffness, double exponent, Pack I) const {
    if (stiffness == 0.0) return 0.0;
    const Pack e = pull(I);
    return 2.0 * stiffness * e * fast_exp(exponent * e * e);
  }
  Pack energy_along(double stiffness, double exponent, Pack I) const {
    if (stiffness == 0.0) return 0.0;
    const Pack e = pull(I);
    return 0.5 * stiffness / exponent * (fast_exp(exponent * e * e) - 1.0);
  }

  LawDirection fibre_{*this, "fibre", fibre};
  LawDirection sheet_{*this, "sheet", sheet, &fibre_};
};

}  // namespace shoal::solid
