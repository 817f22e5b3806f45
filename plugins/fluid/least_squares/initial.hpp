// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Before the first step: the liquid is incompressible, so density and mass are those at rest.
#pragma once

#include "shoal/particle_operator.hpp"

namespace shoal::fluid::least_squares {

struct InitialMass : ParticleOperator<InitialMass> {
  In<Scalar> volume{"volume"};
  Out<Scalar> mass{"mass"};
  Out<Scalar> density{"density"};

  double reference_density = 0;  // kg/m3

  void particle(auto i) const {
    density[i] = reference_density;
    mass[i] = reference_density * volume[i];
  }
};

}  // namespace shoal::fluid::least_squares
