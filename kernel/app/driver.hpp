// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Drives a finalised session to its end: steps, results, checkpoints, progress, and what is said at the end.
#pragma once

#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "kernel/app/session.hpp"
#include "kernel/output/checkpoint_store.hpp"
#include "kernel/output/result_folder.hpp"
#include "kernel/output/run_state.hpp"
#include "kernel/output/summary.hpp"

namespace shoal::kernel::app {

class Driver {
 public:
  /// `begin`: when the program started.
  Driver(const Options& options, Session& session, ResultFolder folder,
         std::chrono::steady_clock::time_point begin);

  /// A new run: initial state, first outputs.
  void start();
  /// Goes on from the newest checkpoint that can be read. Throws CheckpointError if none can, and UserError if the
  /// case is another computation now and the user does not insist.
  void resume();
  /// Steps until the end or a reason to stop; tells how it went. Gives the exit code.
  int drive();

 private:
  using Clock = std::chrono::steady_clock;
  bool load(const std::filesystem::path& checkpoint);
  void check_same_physics(const RunState& state) const;
  void tell_start(const std::string& how) const;
  bool stop_asked() const;
  void step();
  void checkpoint_if_due();
  void write_checkpoint();
  int finish(const std::string& status);
  int fail(const PhysicsFailure& failure);
  void record_failure(const std::string& why) const;
  Summary summary(const std::string& status) const;
  void tell_end(const Summary& summary) const;
  double wall_seconds() const;

  const Options& options_;
  Session& session_;
  ResultFolder folder_;
  CheckpointStore checkpoints_;
  std::string effective_case_;
  std::string started_;
  Clock::time_point begin_, last_checkpoint_;
  Due checkpoint_due_;
  std::optional<double> until_;
  double checkpoint_every_ = 0.0;  // of wall time, s; 0: never
  double start_time_ = 0.0, last_time_ = 0.0;
  double earlier_wall_seconds_ = 0.0;
  double startup_seconds_ = 0.0, checkpoint_seconds_ = 0.0;
  std::uint64_t first_step_ = 0, checkpointed_step_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace shoal::kernel::app
