// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/app/console.hpp"
#include "kernel/app/text.hpp"

namespace shoal::kernel::app {
namespace {

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

// Steps of the fastest loop: what the run is waited for.
std::uint64_t steps_of(const Simulation& run) {
  std::uint64_t most = run.outer_steps();
  for (const std::string& loop : run.loop_names()) most = std::max(most, run.loop_steps(loop));
  return most;
}

double share_of(const Simulation& run) { return run.end_time() > 0.0 ? run.time() / run.end_time() : 1.0; }

}  // namespace

Progress::Progress(const Simulation& run)
    : begin_(Clock::now()),
      last_look_(begin_),
      last_shown_(begin_),
      start_time_(run.time()),
      last_time_(run.time()),
      last_share_(share_of(run)),
      last_steps_(steps_of(run)) {}

void Progress::estimate(const Simulation& run, Clock::time_point now) {
  const double wall = seconds(now - last_look_);
  const std::uint64_t steps = steps_of(run);
  const double per_second = static_cast<double>(steps - last_steps_) / wall;
  const double advance = run.time() - last_time_;
  // The last ten seconds count most; the first look has nothing to be mixed with.
  const double weight = steps_per_second_ == 0.0 ? 1.0 : 1.0 - std::exp(-wall / 10.0);
  steps_per_second_ += weight * (per_second - steps_per_second_);
  if (advance > 0.0) seconds_per_time_ += weight * (wall / advance - seconds_per_time_);
  last_look_ = now;
  last_time_ = run.time();
  last_steps_ = steps;
}

void Progress::step(const Simulation& run) {
  const Clock::time_point now = Clock::now();
  if (seconds(now - last_look_) < 0.2) return;
  estimate(run, now);
  const double since = seconds(now - last_shown_);
  const bool line = since >= 10.0 || (since >= 1.0 && share_of(run) - last_share_ >= 0.1);
  if (Console::has_status_line() || line || (Console::json() && since >= 1.0)) show(run, now);
}

void Progress::show(const Simulation& run, Clock::time_point now) {
  last_shown_ = now;
  last_share_ = share_of(run);
  const double left = seconds_per_time_ * (run.end_time() - run.time());
  if (Console::json()) {
    Console::event({{"event", "progress"},
                    {"time", run.time()},
                    {"end", run.end_time()},
                    {"steps", run.outer_steps()},
                    {"dt", run.last_outer_dt()},
                    {"steps_per_second", steps_per_second_},
                    {"particles", run.n_particles()},
                    {"seconds_left", left}});
    return;
  }
  // Fits the 80 columns of a small terminal.
  const std::string line =
      fmt::format("{:>9} / {}  {:>5}  dt {}  {} steps/s  {} particles  {} left",
                  simulated_time_text(run.time()), simulated_time_text(run.end_time()),
                  percent_text(share_of(run)), simulated_time_text(run.last_outer_dt()),
                  significant(steps_per_second_, 3), count_text(run.n_particles()), duration_text(left));
  if (Console::has_status_line())
    Console::status(line);
  else
    Console::inform(line);
}

void Progress::end() { Console::status(""); }

}  // namespace shoal::kernel::app
