// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of the program, measured by its own summary.
#pragma once

#include <string>

namespace shoal::bench {

/// `cost` of summary.json.
struct Cost {
  double particles = 0, steps_seconds = 0, overhead_seconds = 0, startup_seconds = 0,
         particle_steps_per_second = 0, bytes_per_particle = 0, acoustic_steps = 0;
};

/// A 3D dam break of about so many particles of water, for so many outer steps, without outputs. Throws
/// std::runtime_error with what the program said if it fails.
Cost run_dam_break(double water_particles, int outer_steps, int threads);

}  // namespace shoal::bench
