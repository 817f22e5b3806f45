// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// summary.json: what was computed, at what cost, and how far it is from what is known. For machines; the program
// prints the same for people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/output/reference.hpp"
#include "kernel/schedule/plan.hpp"

namespace shoal::kernel {

struct Summary {
  struct Plugin {
    std::string id, version, path;
  };
  std::string title, case_file, folder;
  std::string version, compiler, build_type, flags;
  std::vector<Plugin> plugins;
  int dimensions = 0;
  int threads = 0;
  std::string started;  ///< local time, ISO 8601
  /// running, finished, stopped (as asked), interrupted, failed
  std::string status;
  std::string failure;                                  ///< why, if it failed
  std::string finish_reason;                            ///< why, if a physics ended it
  double time = 0.0, start_time = 0.0, end_time = 0.0;  ///< s of simulated time
  std::uint64_t outer_steps = 0;                        ///< of all sessions
  double wall_seconds = 0.0;                            ///< of this run of the program, from its start
  double earlier_wall_seconds = 0.0;                    ///< of the sessions that it goes on from
  double startup_seconds = 0.0;                         ///< until the first step
  double output_seconds = 0.0;                          ///< outputs and probes
  double checkpoint_seconds = 0.0;
  std::uint64_t peak_memory = 0;  ///< bytes of the process
  Plan plan;
  Timings timings;
  std::vector<ReferenceResult> references;
};

std::string to_json(const Summary& summary);

/// Particles that move in a step: those that are re-sorted, or all if none is. What rates are counted in.
std::uint64_t moving_particles(const Plan& plan);
/// Of the loop with most steps, over the time spent in steps; 0 before the first.
double particle_steps_per_second(const Plan& plan, const Timings& timings);
/// Of this process, in bytes.
std::uint64_t peak_memory();

}  // namespace shoal::kernel
