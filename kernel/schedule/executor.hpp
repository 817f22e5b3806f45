// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs operators: images, bind, begin, chunks on all threads, reductions in a fixed tree, end. Results do not depend
// on the number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kernel/particles/errors.hpp"
#include "kernel/schedule/neighbourhood.hpp"
#include "kernel/schedule/schedule.hpp"
#include "kernel/schedule/simulation.hpp"
#include "kernel/schedule/stopwatch.hpp"

namespace shoal::kernel {

class Executor {
 public:
  Executor(Neighbourhood& neighbourhood, int dimensions, const FailureChannel& failures, bool poison)
      : neighbourhood_(neighbourhood), dimensions_(dimensions), failures_(failures), poison_(poison) {}

  void clear(const BodyField& what);
  void run(OperatorRun& op, const shoal_step& step);
  /// The largest step that the operator allows. Throws PhysicsFailure if it is not a positive number.
  double time_step(OperatorRun& op, const shoal_step& step);
  /// Of one piece of the particles, for the report of a collapse.
  double time_step_of(const OperatorRun& op, const shoal_step& step, std::uint64_t begin,
                      std::uint64_t end) const;
  /// Lets particles leave and join the operator's body, if it asks for it. `fill_initial(body, begin, end, written)`
  /// gives those that copy none what the operator leaves to others.
  using FillInitial = std::function<void(Body&, std::uint64_t, std::uint64_t, const std::vector<Field*>&)>;
  void exchange(OperatorRun& op, const shoal_step& step);
  FillInitial fill_initial;
  /// Hands views over if arrays, images or lists have moved since the last time.
  void bind(OperatorRun& op);
  /// After a restart, when arrays stayed but what operators derive from them may not hold.
  void forget_bindings() { ++epoch_; }
  /// An operator's own block of a checkpoint.
  void save_or_load(const OperatorRun& op, const shoal_stream& stream, const char* what) const;

  Stopwatch stopwatch;
  std::uint64_t clear_ticks = 0, image_ticks = 0;

  [[noreturn]] void fail(const OperatorRun& op, const char* callback, shoal_status status,
                         const std::string& text, const shoal_step* step) const;

 private:
  std::uint64_t generation() const { return neighbourhood_.generation() + epoch_; }
  void check_exchange(const OperatorRun& op, const shoal_exchange& asked, const shoal_step& step) const;
  void fill(OperatorRun& op, const shoal_step& step, std::span<const std::uint64_t> sources);
  void run_chunks(OperatorRun& op, const shoal_step& step);
  void reduce(OperatorRun& op, std::uint64_t chunks);
  void prepare_partials(OperatorRun& op, std::uint64_t chunks);
  std::string take_text() const;

  Neighbourhood& neighbourhood_;
  int dimensions_;
  FailureChannel failures_;
  bool poison_;
  std::uint64_t epoch_ = 0;
};

}  // namespace shoal::kernel
