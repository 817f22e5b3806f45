// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run consists of and what it cost, as plain data: for `shoal plan`, the timings table and summary.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shoal/abi.h"

namespace shoal::kernel {

struct PlanOperator {
  std::string name;
  std::string body;
  std::vector<std::string> neighbours;  ///< bodies of its relations
  std::vector<std::string> reads, writes, accumulates;
  bool serial = false;
  bool on_demand = false;
  bool limits_time_step = false;
};

struct PlanLoop;

struct PlanStage {
  std::string name;
  std::vector<std::string> clears;      ///< "body.field" set to zero at its beginning
  std::vector<PlanOperator> operators;  ///< in order
  std::vector<PlanLoop> loops;          ///< sub-cycled after the operators
};

struct PlanLoop {
  std::string name;
  bool renews_neighbours = false;
  double time_step_factor = 1.0;
  std::vector<PlanStage> stages;
};

struct PlanRelation {
  std::string body, neighbours;
  shoal_configuration configuration = SHOAL_CURRENT;
  double cutoff = 0.0;                    ///< m
  double mean_neighbours = 0.0;           ///< 0 before the lists are built
  double bytes_per_particle = 0.0;        ///< with what operators keep; 0 before the lists are built
  std::uint32_t kept_bytes_per_pair = 0;  ///< that operators keep beside the list
  std::uint64_t builds = 0;
};

struct PlanField {
  std::string name, unit, doc;
  shoal_rank rank = SHOAL_SCALAR;
  shoal_data_type data_type = SHOAL_DOUBLE;
  std::uint32_t bytes_per_particle = 0;
  bool derived = false;  ///< not in checkpoints
  std::vector<std::string> declared_by;
};

struct PlanBody {
  std::string name, smoothing_kernel;
  std::uint64_t particles = 0;
  std::uint64_t halo_particles = 0;
  double spacing = 0.0, smoothing_length = 0.0, cutoff = 0.0;
  bool moves = false;  ///< re-sorted along cells
  std::vector<PlanField> fields;
  std::uint64_t field_bytes = 0;  ///< allocated
  std::uint64_t list_bytes =
      0;  ///< of the lists whose rows are this body's particles, with what operators keep
  std::uint32_t kept_bytes_per_particle = 0;  ///< that operators keep beside the fields
};

struct Plan {
  std::vector<PlanStage> outside;  ///< "initial" and "sample"
  std::vector<PlanLoop> loops;     ///< the top of the tree
  std::string outer_step_renews;   ///< empty, or why neighbours are renewed once per outer step
  std::vector<PlanRelation> relations;
  std::vector<PlanBody> bodies;
  std::vector<std::string> unscheduled;  ///< on-demand operators that nobody asked for
  std::vector<std::string> notes;
  std::uint64_t particles = 0;
  std::uint64_t total_bytes = 0;  ///< fields and lists as allocated
};

struct OperatorTiming {
  std::string name, body, loop, stage;
  std::uint64_t calls = 0;
  std::uint64_t particles = 0;  ///< visited, all calls together
  std::uint64_t pairs = 0;      ///< true neighbours visited, all calls together
  double seconds = 0.0;         ///< with begin, end and time_step
  double nanoseconds_per_pair() const {
    return pairs == 0 ? 0.0 : 1e9 * seconds / static_cast<double>(pairs);
  }
};

struct LoopTiming {
  std::string name;
  std::uint64_t steps = 0;
  double smallest_dt = 0.0, largest_dt = 0.0, last_dt = 0.0;
  std::string limited_by;  ///< operator that set the last step
};

struct Timings {
  std::vector<OperatorTiming> operators;
  std::vector<LoopTiming> loops;
  std::vector<std::string> remarks;  ///< what operators say of the run so far
  double steps = 0.0;                ///< all of step(), s
  double operators_total = 0.0;
  double neighbour_search = 0.0;               ///< sort, halos and lists together
  double sort = 0.0, halo = 0.0, lists = 0.0;  ///< parts of neighbour_search
  double halo_values = 0.0;                    ///< renewing images between renewals of the lists
  double clear = 0.0;
  double health = 0.0;
  std::uint64_t renewals = 0, sorts = 0, list_builds = 0;
  double outside_steps = 0.0;  ///< operators and neighbour search before the first step or for samples
  /// What steps cost beyond operators and neighbour search.
  double overhead() const { return steps + outside_steps - operators_total - neighbour_search; }
};

}  // namespace shoal::kernel
