// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The stages of the loop `structure`, in order; total_lagrangian.hpp says what happens in each.
#pragma once

#include "shoal/physics.hpp"

namespace shoal::solid {

inline constexpr At at_drift{"structure", "drift"};
inline constexpr At at_half_motion{"structure", "half_motion"};
inline constexpr At at_deformation{"structure", "deformation"};
inline constexpr At at_stress{"structure", "stress"};
inline constexpr At at_forces{"structure", "forces"};
inline constexpr At at_kick{"structure", "kick"};
inline constexpr At at_constraints{"structure", "constraints"};

inline void declare_loop(const Builder& builder) {
  builder.loop("structure",
               {"drift", "half_motion", "deformation", "stress", "forces", "kick", "constraints"});
}

}  // namespace shoal::solid
