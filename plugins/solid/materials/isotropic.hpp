// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What isotropic materials have in common: density, Young's modulus E and Poisson's ratio nu.
//   mu = E / (2 (1 + nu)),  lambda = E nu / ((1 + nu)(1 - 2 nu)),  K = E / (3 (1 - 2 nu))
#pragma once

#include "shoal/stress_law.hpp"
#include "tensors.hpp"

namespace shoal::solid {

class IsotropicLaw : public StressLaw {
 public:
  Param<double> density{"density", "kg/m3", "Density of the undeformed material.", positive, example("1000")};
  Param<double> youngs_modulus{"youngs_modulus", "Pa", "Young's modulus.", positive, example("1.4 MPa")};
  Param<double> poisson_ratio{"poisson_ratio", "1",        "Poisson's ratio; 0.5 would be incompressible.",
                              above(-1.0),     below(0.5), example("0.4")};

  double mu() const { return 0.5 * youngs_modulus / (1.0 + poisson_ratio); }
  double lambda() const { return bulk_modulus() - 2.0 / 3.0 * mu(); }

  double reference_density() const override { return density; }
  double bulk_modulus() const override { return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)); }
  double shear_modulus() const override { return mu(); }
};

}  // namespace shoal::solid
