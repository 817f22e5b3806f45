// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What contact and walls add to the stiffness of a body, so that its stable step knows of them.
//
// A surface that presses with p = k x at an overlap x, of particles with mass rho dx per area, moves at most with
// w^2 = 2 k / (rho dx): both sides give way. With the body's own w0 no mode is faster than sqrt(w0^2 + w^2).
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "shoal/interfaces/stress_law.h"
#include "shoal/physics.hpp"

namespace shoal::solid {

// Sum of 2 k / dx of a body (k / dx of rigid walls), Pa/m2: added to rho w^2.
using SharedStiffness = std::shared_ptr<double>;

// The physics of contact and that of the motion are built one after the other, whichever comes first, and know each
// other by the body and its material alone.
inline SharedStiffness added_stiffness(const Builder& b, BodyIndex body) {
  static std::map<std::pair<const void*, std::uint32_t>, std::weak_ptr<double>> known;
  const auto law = b.material_interface<shoal_stress_law>(body, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
  std::weak_ptr<double>& entry = known[{law.self, body.value}];
  SharedStiffness stiffness = entry.lock();
  if (!stiffness) entry = stiffness = std::make_shared<double>(0.0);
  return stiffness;
}

}  // namespace shoal::solid
