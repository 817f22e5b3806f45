// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Interface of a material: reactions of quantities that a particle holds, dy/dt = q(y) - p(y) y for each variable y.
// The diffusion plugin calls it with blocks of particles; a third party adds an ionic model of a cell, or a chemistry,
// by registering a material that offers this interface (in C++ through shoal/reaction_model.hpp).
//
// How a rate is divided into q and p is the model's choice and does not change what is solved, but steps are exact
// where q and p are constant and stay between y and q / p at any length: choose p >= 0 and q / p the value that y
// strives for, e.g. y_inf / tau and 1 / tau of a gate. p = 0 is allowed.
#pragma once

#include "shoal/abi.h"

#define SHOAL_REACTION_MODEL "reaction_model"
#define SHOAL_REACTION_MODEL_REVISION 1u

typedef struct shoal_reaction_variable {
  uint32_t size;
  uint32_t reserved;
  const char* name;  // of the field, snake_case
  const char* unit;  // UDUNITS-2
  const char* doc;
  double initial;    // value where the case gives none
  double tolerance;  // error of the variable that may be made in one step; 0: steps do not look at it
  double
      excited;  // of the first variable: lifted to it, an excitable medium sends out a wave; else `initial`
} shoal_reaction_variable;

typedef struct shoal_reaction_model {
  uint32_t size;
  uint32_t reserved;
  // The variables; their number is returned and the array is the model's. 0 if what the case gives the model does not fit
  // together, after host->fail. [any]
  uint32_t (*variables)(void* self, const shoal_reaction_variable** variables);
  // Longest step between reaction and diffusion that resolves the model, s. [any]
  double (*largest_step)(void* self);
  // q[v][i] and p[v][i] (1/s times the unit of v, and 1/s) of n particles at time t from y[v][i]. `position` holds
  // n * dimensions numbers, interleaved. y may be read, q and p written, up to the next multiple of SHOAL_PADDING;
  // what stands behind n is nobody's. [worker]
  shoal_status (*rates)(void* self, int32_t dimensions, double t, uint64_t n, const double* position,
                        const double* const* y, double* const* q, double* const* p);
} shoal_reaction_model;
