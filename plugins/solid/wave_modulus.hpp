// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Modulus of longitudinal waves rho c^2 of a body, by its stress law: how stiff a contact should be.
#pragma once

#include <string>

#include "shoal/interfaces/stress_law.h"
#include "shoal/physics.hpp"

namespace shoal::solid {

inline double wave_modulus(const Builder& b, BodyIndex body) {
  const auto law = b.material_interface<shoal_stress_law>(body, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
  if (!law)
    throw CaseError(std::string("body '") + b.body(body).name +
                    "' is in contact and needs a material with a stress law, which says how stiff it is");
  shoal_elastic_constants c{};
  c.size = sizeof c;
  law.api->constants(law.self, b.dimensions() == 3 ? SHOAL_THREE_DIMENSIONAL : SHOAL_PLANE_STRAIN, &c);
  return c.density * c.longitudinal_speed * c.longitudinal_speed;
}

}  // namespace shoal::solid
