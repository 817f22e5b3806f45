// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of the fields that belong to a diffusing field c, which the case names.
#pragma once

#include <deque>
#include <string>

namespace shoal::diffusion {

// Operators keep the texts that their fields are renamed to.
class Names {
 public:
  const char* keep(std::string text) { return texts_.emplace_back(std::move(text)).c_str(); }

 private:
  std::deque<std::string> texts_;
};

// dc/dt, to which all that changes c in a stage of the integrator adds.
inline std::string rate_of(const std::string& field) { return field + "_rate"; }
// c at the beginning of the step, its rate there, and c one stage earlier.
inline std::string start_of(const std::string& field) { return field + "_start"; }
inline std::string start_rate_of(const std::string& field) { return field + "_start_rate"; }
inline std::string previous_of(const std::string& field) { return field + "_previous"; }
// What holds at the surface point of a particle, and the data there (surface.hpp).
inline std::string surface_of(const std::string& field) { return field + "_surface"; }
inline std::string surface_data_of(const std::string& field) { return field + "_surface_data"; }
// K, per particle: a scalar or a tensor.
inline std::string conductivity_of(const std::string& field) { return field + "_conductivity"; }

}  // namespace shoal::diffusion
