// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Interface of a material: how pressure and density of a weakly compressible fluid hang together. The fluid plugin
// calls it with blocks of particles; a third party adds an equation of state by registering a material that offers
// this interface.
#pragma once

#include "shoal/abi.h"

#define SHOAL_EQUATION_OF_STATE "equation_of_state"
#define SHOAL_EQUATION_OF_STATE_REVISION 1u

typedef struct shoal_equation_of_state {
  uint32_t size;
  uint32_t reserved;
  // Density at rest, kg/m3. [any]
  double (*reference_density)(void* self);
  // Dynamic viscosity, Pa s; 0 for an inviscid fluid. [any]
  double (*viscosity)(void* self);
  // Told once, before all else, which sound speed (m/s) keeps the density variation of the run near 1 %; returns the
  // one that holds (a material with a sound speed of its own returns that). [main]
  double (*set_sound_speed)(void* self, double suggested);
  // Blocks of n particles: p(rho), rho(p). [worker]
  void (*pressure)(void* self, uint64_t n, const double* density, double* pressure);
  void (*density)(void* self, uint64_t n, const double* pressure, double* density);
} shoal_equation_of_state;
