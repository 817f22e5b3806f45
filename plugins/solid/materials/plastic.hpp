// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// J2 plasticity with linear hardening and saturation (Voce 1948):
//   sigma_y(alpha) = sigma_0 + H alpha + (sigma_inf - sigma_0) [1 - exp(-delta alpha)]
#pragma once

#include "j2_plasticity.hpp"

namespace shoal::solid {

class Plastic final : public J2Plasticity {
 public:
  Param<double> yield_stress_{"yield_stress", "Pa", "Stress at which it begins to yield.", positive,
                              example("0.4 GPa")};
  Param<double> hardening{"hardening",
                          "Pa",
                          "Rise of the yield stress per plastic strain; 0 is perfectly plastic.",
                          non_negative,
                          default_to(0.0),
                          example("0.1 GPa")};
  Param<double> saturation_stress{"saturation_stress",
                                  "Pa",
                                  "Yield stress that hardening saturates at, besides the linear part (Voce).",
                                  positive,
                                  optional,
                                  example("0.715 GPa")};
  Param<double> saturation_rate{"saturation_rate", "1",      "How fast it saturates: exp(-rate alpha).",
                                positive,          optional, example("16.93")};

  void check() override {
    if (saturation_stress.is_set() != saturation_rate.is_set())
      throw CaseError((saturation_stress.is_set() ? saturation_stress.place() : saturation_rate.place()) +
                      ": saturation_stress and saturation_rate belong together");
    if (saturation_stress.is_set() && saturation_stress < yield_stress_)
      throw CaseError(saturation_stress.place() + ": saturation_stress is less than yield_stress");
  }

 protected:
  YieldStress yield_stress(Pack before, Pack increment, LawPoint&) const override {
    const Pack alpha = before + increment;
    YieldStress y{yield_stress_.value() + hardening.value() * alpha, Pack(hardening.value())};
    if (saturation_stress.is_set()) {
      const double rise = saturation_stress - yield_stress_;
      const Pack left = exp(-saturation_rate.value() * alpha);
      y.value += rise * (1.0 - left);
      y.slope += rise * saturation_rate * left;
    }
    return y;
  }
};

}  // namespace shoal::solid
