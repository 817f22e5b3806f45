// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A weakly compressible liquid and its equation of state: linear,
//   p = c^2 (rho - rho0),
// or Tait's,
//   p = rho0 c^2 / gamma [(rho / rho0)^gamma - 1]          (Cole 1948; Monaghan 1994 for SPH).
#pragma once

#include <cmath>

#include "shoal/interfaces/equation_of_state.h"
#include "shoal/material.hpp"

namespace shoal::fluid {

struct Liquid final : Material {
  Param<double> density{"density", "kg/m3", "Density at rest.", positive, example("1000")};
  Param<double> viscosity{
      "viscosity",  "Pa s",          "Dynamic viscosity; 0 leaves viscosity out of the run.",
      non_negative, default_to(0.0), example("1e-3")};
  Param<double> sound_speed{"sound_speed",
                            "m/s",
                            "Artificial speed of sound. Without it ten times the largest speed that the "
                            "physics expects, which keeps the "
                            "density within about 1 %.",
                            positive,
                            optional,
                            example("20")};
  Param<Choice> equation_of_state{
      "equation_of_state", nullptr,
      "linear: p = c^2 (rho - rho0). tait: stiffer under compression, for comparison with "
      "codes that use it.",
      one_of("linear", "tait"), default_to("linear")};
  Param<double> exponent{"exponent", "1", "Exponent gamma of Tait's equation.", positive, default_to(7.0)};

  const void* interface(std::string_view name, std::uint32_t revision) const override {
    return name == SHOAL_EQUATION_OF_STATE && revision == SHOAL_EQUATION_OF_STATE_REVISION ? &table_
                                                                                           : nullptr;
  }

 private:
  static Liquid& of(void* self) { return material_of<Liquid>(self); }

  void pressures(std::uint64_t n, const double* rho, double* p) const {
    const double rho0 = density;
    if (equation_of_state.value() == "linear") {
      for (std::uint64_t i = 0; i < n; ++i) p[i] = c_ * c_ * (rho[i] - rho0);
    } else {
      const double stiffness = rho0 * c_ * c_ / exponent;
      for (std::uint64_t i = 0; i < n; ++i) p[i] = stiffness * (std::pow(rho[i] / rho0, exponent) - 1.0);
    }
  }
  void densities(std::uint64_t n, const double* p, double* rho) const {
    const double rho0 = density;
    if (equation_of_state.value() == "linear") {
      for (std::uint64_t i = 0; i < n; ++i) rho[i] = rho0 + p[i] / (c_ * c_);
    } else {
      const double stiffness = rho0 * c_ * c_ / exponent;
      for (std::uint64_t i = 0; i < n; ++i) rho[i] = rho0 * std::pow(p[i] / stiffness + 1.0, 1.0 / exponent);
    }
  }

  double c_ = 0;

  static const shoal_equation_of_state table_;
};

// Outside of the class, in whose static initialisers it is still incomplete.
inline const shoal_equation_of_state Liquid::table_{
    sizeof(shoal_equation_of_state),
    0,
    [](void* self) { return of(self).density.value(); },
    [](void* self) { return of(self).viscosity.value(); },
    [](void* self, double suggested) { return of(self).c_ = of(self).sound_speed.value_or(suggested); },
    [](void* self, std::uint64_t n, const double* rho, double* p) { of(self).pressures(n, rho, p); },
    [](void* self, std::uint64_t n, const double* p, double* rho) { of(self).densities(n, p, rho); }};

// A solid wall. Its particles do not move by themselves; their velocity is that of the wall's surface.
struct Wall final : Material {
  Param<Choice> slip{
      "slip", nullptr,
      "no_slip: a viscous fluid sticks to the wall. free_slip: the wall exerts no friction, e.g. where "
      "the boundary layer is thinner than the particles.",
      one_of("no_slip", "free_slip"), default_to("no_slip")};
};

}  // namespace shoal::fluid
