// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The run: bodies, fields, relations and a tree of loops, driven one outer step at a time. It knows neither physics
// nor case files, prints nothing, and throws the exceptions of kernel/particles/errors.hpp.
//
//   Simulation run(settings);
//   run.add_body(...);                          // all bodies first
//   run.set_declarer("fluid.wcsph");            // for messages
//   physics->build(object, run.builder());      // all physics; a failed call leaves its text in builder_failure()
//   run.demand_field("water", "vorticity");     // what outputs and probes want to read
//   run.finalise();                             // resolve, check, allocate; nothing has run yet: plan() is complete
//   run.initialise();  or  run.load(stream);    // stage "initial", or a checkpoint instead
//   while (!run.finished()) { run.step(); if (due) { run.sample(); write(run.field("water", "velocity")); } }
//
// All functions belong to one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/particles/domain.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/schedule/plan.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// How texts of failed callbacks travel: `put` is what shoal_host::fail does, `take` gives the calling thread's text
/// and forgets it. Without them a text of the engine's own per thread is used.
struct FailureChannel {
  void (*put)(const char* text) = nullptr;
  std::string (*take)() = nullptr;
};

struct SimulationSettings {
  int dimensions = 3;
  double gravity[3] = {0.0, 0.0, 0.0};  // m/s2
  double end_time = 0.0;                // s
  /// The domain, m. Needed on axes with periodic or mirror faces. Where an axis is open and nothing is given, a
  /// particle has escaped once it is further outside the initial bounds of all particles than their extent there.
  std::optional<double> lower[3], upper[3];
  AxisBoundary boundaries[3];
  std::map<std::string, double> time_step_factors;  ///< by loop name; multiply what the operators allow
  int threads = 0;                                  ///< 0: as many as the machine has
  std::uint64_t sort_interval = 0;  ///< renewals between re-sorts of moving bodies; 0: the kernel's choice
  /// Fills images that are stale or were never declared with NaN, and derived fields after a restart, so that an
  /// undeclared read is seen. On in debug builds.
#ifdef NDEBUG
  bool poison = false;
#else
  bool poison = true;
#endif
  FailureChannel failures;
  /// Why an operator wants the run to end since the last call (shoal_host::finish); empty if none does.
  std::string (*take_finish)() = nullptr;
};

/// Values of a field at the start: `evaluate` gets n interleaved positions and fills n * components values.
struct InitialField {
  std::string name;
  shoal_rank rank = SHOAL_SCALAR;
  std::function<void(std::uint64_t n, const double* positions, double* out)> evaluate;
  std::string place;              ///< in the case, for messages
  bool only_if_declared = false;  ///< no error if nobody declares the field
};

struct BodySpecification {
  std::string name;
  double spacing = 0.0;           // m
  double smoothing_length = 0.0;  // m
  double cutoff = 0.0;            // m
  std::string smoothing_kernel;
  std::vector<double> positions;  ///< interleaved, as many numbers per particle as dimensions
  std::vector<double> volumes;    ///< empty: spacing^dimensions
  const shoal_object* material = nullptr;
  std::vector<InitialField> initial_fields;
  std::string place;  ///< in the case, for messages
};

struct FieldInfo {
  std::string name, unit, doc;
  shoal_rank rank = SHOAL_SCALAR;
  shoal_data_type data_type = SHOAL_DOUBLE;
  std::uint32_t components = 1;
};

using MaterialInterfaceLookup = std::function<void(const shoal_object* material, const char* name,
                                                   std::uint32_t revision, const void** api, void** self)>;

class Simulation {
 public:
  explicit Simulation(const SimulationSettings& settings);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // -- building -------------------------------------------------------------------------------------------------
  /// Index of the body. Not after the first call of builder().
  std::uint32_t add_body(BodySpecification specification);
  void set_material_interface_lookup(MaterialInterfaceLookup lookup);
  const shoal_builder* builder();
  /// Whose declarations follow, e.g. "fluid.wcsph (dam_break.yaml:20:5)".
  void set_declarer(std::string text);
  /// Why the last builder function that returned a status other than SHOAL_OK did so.
  const std::string& builder_failure() const;
  /// An output or probe will read this field. Throws ModelError in finalise() if nobody declares it.
  void demand_field(std::string_view body, std::string_view field, std::string place = {});
  /// Whether a physics has spoken of this field of the body, also if only on demand: then it may be demanded. Before
  /// finalise().
  bool is_declared(std::string_view body, std::string_view field) const;
  /// Resolves attachments, prunes on-demand operators, checks, allocates. Runs nothing. Throws ModelError.
  void finalise();

  // -- running --------------------------------------------------------------------------------------------------
  /// Initial values, first neighbour lists, stage "initial".
  void initialise();
  /// One outer step, not beyond `no_later_than` or the end of the run. Throws PhysicsFailure, OperatorFailure.
  void step(double no_later_than = std::numeric_limits<double>::infinity());
  /// Runs stage "sample".
  void sample();
  /// At the end that the settings name, or where an operator said that the run has come to what it is for.
  bool finished() const;
  const std::string& finish_reason() const;    ///< empty unless an operator ended the run
  void set_finish_reason(std::string reason);  ///< of a run that is resumed; empty: it goes on
  double time() const;                         ///< s
  double end_time() const;                     ///< s
  void set_end_time(double end_time);          ///< s; a resumed run may be longer
  std::uint64_t outer_steps() const;
  double last_outer_dt() const;                 ///< s; 0 before the first step
  std::vector<std::string> loop_names() const;  ///< depth first
  std::uint64_t loop_steps(std::string_view loop) const;
  double last_dt(std::string_view loop) const;  ///< s

  // -- looking --------------------------------------------------------------------------------------------------
  int dimensions() const;
  std::uint32_t n_bodies() const;
  const std::string& body_name(std::uint32_t body) const;
  std::optional<std::uint32_t> find_body(std::string_view name) const;
  std::uint64_t n_particles(std::uint32_t body) const;  ///< owned
  std::uint64_t n_particles() const;
  const std::int64_t* ids(std::uint32_t body) const;
  /// Of the fields that exist after finalise().
  std::vector<FieldInfo> fields(std::uint32_t body) const;
  std::optional<FieldInfo> field_info(std::uint32_t body, std::string_view field) const;
  /// data is NULL if the body has no such field. Valid until the next call of a function that runs something.
  shoal_field field(std::uint32_t body, std::string_view field) const;
  Plan plan() const;
  Timings timings() const;
  std::uint64_t memory(std::uint32_t body) const;  ///< bytes of its fields and lists

  // -- checkpoints ----------------------------------------------------------------------------------------------
  /// A run that is saved, loaded into a fresh finalised Simulation of the same case, and continued is bitwise equal
  /// to the one that went on. Between steps only. Throws CheckpointError.
  void save(std::ostream& stream);
  /// Instead of initialise(). Everything is verified before anything is changed. Throws CheckpointError.
  void load(std::istream& stream);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace shoal::kernel
