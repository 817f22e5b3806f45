// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// J2 plasticity of metals at high rates (Johnson, Cook 1983):
//   sigma_y = [A + B alpha^n] [1 + C ln(max(1, rate / rate_0))] [1 - T*^m],   T* = (T - T_0) / (T_melt - T_0) in [0, 1]
// The rate is that of the step; the temperature rises by the plastic work that becomes heat (adiabatic),
//   rho c dT = chi sigma_y d alpha,   chi = 0.9 (Taylor, Quinney 1934).
// State beside that of J2 plasticity: plastic_heating, T - T_0.
#pragma once

#include "j2_plasticity.hpp"

namespace shoal::solid {

class JohnsonCook final : public J2Plasticity {
 public:
  Param<double> A{"a", "Pa", "Yield stress at rest, at the reference temperature.", positive,
                  example("90 MPa")};
  Param<double> B{"b", "Pa", "Coefficient of hardening.", non_negative, example("292 MPa")};
  Param<double> n{"n", "1", "Exponent of hardening.", above(0.0), at_most(1.0), example("0.31")};
  Param<double> C{"c", "1", "Coefficient of the rate.", non_negative, default_to(0.0), example("0.025")};
  Param<double> reference_rate{"reference_rate", "1/s", "Rate above which the yield stress rises.", positive,
                               default_to(1.0)};
  Param<double> m{"m", "1", "Exponent of thermal softening.", positive, default_to(1.0), example("1.09")};
  Param<double> melting{
      "melting_temperature_rise",
      "K",
      "Melting temperature less the temperature at the start; without it there is no softening.",
      positive,
      optional,
      example("1063")};
  Param<double> heat_capacity{"heat_capacity", "J/kg/K", "Specific heat, which the softening needs.",
                              positive,        optional, example("383")};
  Param<double> work_to_heat{"work_to_heat", "1", "Part of the plastic work that becomes heat.",
                             between(0.0, 1.0), default_to(0.9)};

  void check() override {
    if (melting.is_set() != heat_capacity.is_set())
      throw CaseError((melting.is_set() ? melting.place() : heat_capacity.place()) +
                      ": melting_temperature_rise and heat_capacity belong together");
  }

 protected:
  YieldStress yield_stress(Pack before, Pack increment, LawPoint& point) const override {
    // The slope of alpha^n is infinite at zero; a strain below this is none.
    const Pack alpha = max(Pack(1e-10), before + increment);
    const Pack power = pow(alpha, n.value());
    const Pack softening = soft(point);
    Pack fast = 1.0, fast_slope = 0.0;
    if (C > 0.0 && point.dt() > 0.0) {
      const Pack rate = increment / (reference_rate * point.dt());
      fast += C.value() * log(max(Pack(1.0), rate));
      fast_slope = select(rate > 1.0, C.value() / max(Pack(1e-300), increment), Pack(0.0));
    }
    const Pack strength = A.value() + B.value() * power;
    return {strength * fast * softening, (B * n * power / alpha * fast + strength * fast_slope) * softening};
  }
  void flowed(Pack stress, Pack increment, LawPoint& point) const override {
    if (!melting.is_set()) return;
    point.set(heating_, point(heating_) + work_to_heat / (density * heat_capacity) * stress * increment);
  }

 private:
  // At the temperature of the beginning of the step.
  Pack soft(const LawPoint& point) const {
    if (!melting.is_set()) return 1.0;
    const Pack T = min(Pack(1.0), max(Pack(0.0), point(heating_) / melting.value()));
    return 1.0 - select(T > 0.0, pow(T, m.value()), Pack(0.0));
  }

  LawScalar heating_{*this, "plastic_heating", "K", "Rise of the temperature by plastic work.", 0.0};
};

}  // namespace shoal::solid
