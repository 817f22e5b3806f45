// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How a run is getting on: one line that renews itself on a terminal, a line now and then elsewhere, events with
// --json.
#pragma once

#include <chrono>
#include <cstdint>

#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel::app {

class Progress {
 public:
  explicit Progress(const Simulation& run);
  /// After each step; costs next to nothing most of the time.
  void step(const Simulation& run);
  /// Removes the line from the terminal.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const Simulation& run, Clock::time_point now);
  void estimate(const Simulation& run, Clock::time_point now);

  Clock::time_point begin_, last_look_, last_shown_;
  double start_time_, last_time_, last_share_;
  std::uint64_t last_steps_;
  double seconds_per_time_ = 0.0;  // of wall per simulated time, lately
  double steps_per_second_ = 0.0;
};

}  // namespace shoal::kernel::app
