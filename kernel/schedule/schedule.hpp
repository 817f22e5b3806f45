// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The schedule in the form in which it runs: a tree of loops whose stages are flat lists of pointers. Nothing is
// looked up by name from here on.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kernel/particles/body.hpp"
#include "kernel/schedule/declarations.hpp"

namespace shoal::kernel {

struct BodyField {
  Body* body = nullptr;
  Field* field = nullptr;
};

struct OperatorRun {
  Attachment attachment;
  std::string loop, stage;  ///< resolved
  Body* body = nullptr;
  std::vector<std::uint32_t> relations;  ///< of the neighbourhood, in the order of the operator's

  std::vector<BodyField> images;  ///< whose halo values must be fresh before it runs
  std::vector<Field*> written;    ///< of its own body
  bool moves_particles = false;   ///< writes positions

  // What bind handed over, and when.
  std::uint64_t bound_generation = 0;
  std::vector<Field*> own_fields;            ///< [access]
  std::vector<Field*> fields_of_neighbours;  ///< [relation * accesses + access]
  std::vector<shoal_field> own, of_neighbours;
  std::vector<shoal_neighbours> neighbours;

  std::vector<double> partials;  ///< [chunk * reductions + reduction], or [chunk] of time_step
  std::vector<double> results;

  // Timing.
  std::uint64_t calls = 0, particles = 0, pairs = 0, ticks = 0;
  std::uint64_t pairs_per_call = 0;

  explicit OperatorRun(Attachment what) : attachment(std::move(what)) {}
  const shoal_operator& c() const { return attachment.op.c(); }
};

struct LoopRun;

struct StageRun {
  std::string name;
  std::vector<BodyField> clears;
  std::vector<OperatorRun*> operators;
  std::vector<LoopRun*> loops;  ///< after the operators
};

struct LoopRun {
  std::string name;
  LoopRun* parent = nullptr;
  std::vector<StageRun> stages;
  std::vector<OperatorRun*> limiters;  ///< operators with a time_step
  bool renews_neighbours = false;
  double factor = 1.0;

  // State.
  double time = 0.0;  ///< s, at the beginning of the present step
  std::uint64_t steps = 0;
  double last_dt = 0.0, smallest_dt = std::numeric_limits<double>::infinity(), largest_dt = 0.0;
  OperatorRun* limited_by = nullptr;  ///< NULL: the parent's step, or the end of the run
  double limit = 0.0;                 ///< that holds for the next step; used by loops at the top
};

struct Schedule {
  std::vector<std::unique_ptr<OperatorRun>> operators;  ///< in the order of attachment
  std::vector<std::unique_ptr<LoopRun>> loops;          ///< in the order of declaration
  std::vector<LoopRun*> top;
  StageRun initial, sample;
  std::vector<OperatorRun*> exchanges;  ///< operators that let particles join and leave
  bool renews_in_outer_step = false;
  std::string outer_renewal;  ///< why
  std::vector<std::string> unscheduled;

  LoopRun* find_loop(std::string_view name) const {
    for (const auto& loop : loops)
      if (loop->name == name) return loop.get();
    return nullptr;
  }
};

}  // namespace shoal::kernel
