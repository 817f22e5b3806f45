// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The step loop. An outer step is the largest step that a loop at the top asks for; every loop covers the step of
// its parent (or the outer step) with as many equal steps of its own as its operators' limits demand, and asks them
// anew before each.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/schedule/executor.hpp"
#include "kernel/schedule/health.hpp"
#include "kernel/schedule/neighbourhood.hpp"
#include "kernel/schedule/schedule.hpp"

namespace shoal::kernel {

/// A loop's limit below this fraction of the largest step that it has made means that the run has collapsed.
inline constexpr double collapse_fraction = 1e-6;
/// Steps of a run that no operator limits.
inline constexpr double steps_without_limit = 1000.0;

class Stepper {
 public:
  Stepper(Schedule& schedule, Executor& executor, Neighbourhood& neighbourhood, Health& health,
          int dimensions);

  /// One outer step, at most to `target`; `span` is the length of the whole run, for runs without any limit.
  void step(double target, double span);
  /// A stage outside the loops.
  void run_outside(StageRun& stage);
  /// Wraps positions, checks them, and renews neighbours.
  void renew();
  /// Before that, in a step: particles join and leave.
  void exchange(const shoal_step& step);
  void check_health();
  /// Forgets what was measured before the first step.
  void start_timing();

  double time = 0.0;  ///< s
  std::uint64_t outer_steps = 0;
  double last_dt = 0.0;  ///< s
  std::uint64_t step_ticks = 0, health_ticks = 0, renewal_ticks = 0;

 private:
  double outer_step(double target, double span);
  double limit(LoopRun& loop, const shoal_step& step);
  void cover(LoopRun& loop, double begin, double span, double known_limit);
  void run_stage(StageRun& stage, const shoal_step& step);
  shoal_step describe(const LoopRun& loop, double dt, double parent_time, double parent_dt) const;
  shoal_step outside(double dt) const;
  [[noreturn]] void collapse(const LoopRun& loop, const OperatorRun& op, const shoal_step& step,
                             double limit) const;
  Whereabouts whereabouts() const;

  Schedule& schedule_;
  Executor& executor_;
  Neighbourhood& neighbourhood_;
  Health& health_;
  int dimensions_;
};

}  // namespace shoal::kernel
