// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts of a run and what ties them together; private to kernel/schedule.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/schedule/builder.hpp"
#include "kernel/schedule/executor.hpp"
#include "kernel/schedule/health.hpp"
#include "kernel/schedule/neighbourhood.hpp"
#include "kernel/schedule/schedule.hpp"
#include "kernel/schedule/simulation.hpp"
#include "kernel/schedule/stepper.hpp"

namespace shoal::kernel {

class Simulation::Implementation {
 public:
  explicit Implementation(const SimulationSettings& what);

  enum class Phase { bodies, building, finalised, running };
  void need(Phase phase, const char* what) const;

  std::uint32_t add_body(BodySpecification specification);
  Builder& the_builder();
  void finalise();
  void initialise();

  Plan plan() const;
  Timings timings() const;
  void save(std::ostream& stream);
  void load(std::istream& stream);

  /// Runs on as many threads as the settings say.
  template <class Function>
  void on_threads(const Function& function) {
    arena.execute(function);
  }

  SimulationSettings settings;
  Domain domain;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<BodySpecification> specifications;  ///< positions have moved into the bodies
  Declarations declarations;
  std::unique_ptr<Builder> builder;
  Neighbourhood neighbourhood;
  Executor executor;
  Schedule schedule;
  Health health;
  Stepper stepper;
  /// Only where more threads are asked for than the machine has cores.
  std::optional<tbb::global_control> more_threads;
  tbb::task_arena arena;
  std::string finish_reason;
  Phase phase = Phase::bodies;
  std::uint64_t renewal_ticks_before_steps = 0;

 private:
  void make_domain();
  void declare_initial_fields();
  void declare_reference_positions();
  void set_initial_values();
  void set_initial_fields(Body& body, std::uint64_t begin, std::uint64_t end,
                          const std::vector<Field*>& except) const;
};

}  // namespace shoal::kernel
