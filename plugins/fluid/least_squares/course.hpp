// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the operators of fluid.least_squares tell one another about the step that they are in. It is set anew in each
// advection step, from fields and parameters alone, so nothing of it has to survive a restart.
#pragma once

#include <memory>

#include "shoal/vec.hpp"

namespace shoal::fluid::least_squares {

struct Course {
  double dt = 0;               // s, of the advection step
  double sound_speed = 0;      // m/s, in this step
  double laplacian_norm = 0;   // 1/m2, of the stiffest particle (fit.hpp)
  int viscous_stages = 1;      // of the super-time-stepping
  int viscous_stage = 0;       // 1 ... viscous_stages while they run
  bool first_acoustic = true;  // the first of the acoustic sub-steps kicks by half a step
};
using CoursePointer = std::shared_ptr<Course>;

}  // namespace shoal::fluid::least_squares
