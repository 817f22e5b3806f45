// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shoal/particle_operator.hpp"

namespace shoal::solid {

struct Gravity : ParticleOperator<Gravity> {
  Accumulate<Vector> acceleration{"acceleration"};
  Vector3 gravity{};

  void particle(auto i) const {
    for (int a = 0; a < decltype(i)::dimensions; ++a) acceleration[i][a] += gravity[static_cast<std::size_t>(a)];
  }
};

}  // namespace shoal::solid
