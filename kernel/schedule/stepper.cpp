// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loops, stages, sub-cycles.
#include "kernel/schedule/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace shoal::kernel {

namespace {

// Two lengths of time that differ by less are the same: avoids a last step of rounding error.
constexpr double slack = 1.0 + 1e-9;

}  // namespace

Stepper::Stepper(Schedule& schedule, Executor& executor, Neighbourhood& neighbourhood, Health& health,
                 int dimensions)
    : schedule_(schedule),
      executor_(executor),
      neighbourhood_(neighbourhood),
      health_(health),
      dimensions_(dimensions) {}

Whereabouts Stepper::whereabouts() const {
  return {schedule_.top.size() == 1 ? schedule_.top.front()->name : "outer step", outer_steps, time};
}

shoal_step Stepper::describe(const LoopRun& loop, double dt, double parent_time, double parent_dt) const {
  shoal_step step;
  step.size = sizeof step;
  step.dimensions = dimensions_;
  step.time = loop.time;
  step.dt = dt;
  step.number = loop.steps;
  step.parent_dt = loop.parent != nullptr ? parent_dt : dt;
  step.parent_time = loop.parent != nullptr ? parent_time : loop.time;
  return step;
}

void Stepper::run_stage(StageRun& stage, const shoal_step& step) {
  for (const BodyField& field : stage.clears) executor_.clear(field);
  for (OperatorRun* op : stage.operators) executor_.run(*op, step);
  for (LoopRun* loop : stage.loops) cover(*loop, step.time, step.dt, -1.0);
}

shoal_step Stepper::outside(double dt) const {
  shoal_step step{};
  step.size = sizeof step;
  step.dimensions = dimensions_;
  step.time = step.parent_time = time;
  step.dt = step.parent_dt = dt;
  step.number = outer_steps;
  return step;
}

void Stepper::run_outside(StageRun& stage) {
  const shoal_step step = outside(0.0);
  executor_.stopwatch.start();
  run_stage(stage, step);
}

void Stepper::renew() {
  neighbourhood_.wrap_positions();
  health_.check_positions(whereabouts());
  neighbourhood_.renew();
  renewal_ticks += executor_.stopwatch.lap();
}

void Stepper::exchange(const shoal_step& step) {
  for (OperatorRun* op : schedule_.exchanges) executor_.exchange(*op, step);
}

void Stepper::check_health() {
  health_.check(whereabouts());
  health_ticks += executor_.stopwatch.lap();
}

void Stepper::start_timing() {
  step_ticks = health_ticks = renewal_ticks = 0;
  executor_.clear_ticks = executor_.image_ticks = 0;
  neighbourhood_.sort_ticks = neighbourhood_.halo_ticks = neighbourhood_.list_ticks = 0;
}

double Stepper::limit(LoopRun& loop, const shoal_step& step) {
  double smallest = std::numeric_limits<double>::infinity();
  loop.limited_by = nullptr;
  for (OperatorRun* op : loop.limiters) {
    const double allowed = loop.factor * executor_.time_step(*op, step);
    if (!(allowed > collapse_fraction * loop.largest_dt)) collapse(loop, *op, step, allowed);
    if (allowed < smallest) {
      smallest = allowed;
      loop.limited_by = op;
    }
  }
  return smallest;
}

void Stepper::cover(LoopRun& loop, double begin, double span, double known_limit) {
  loop.time = begin;
  double covered = 0.0;
  for (bool last = false; !last;) {
    if (loop.renews_neighbours) {
      exchange(describe(loop, loop.last_dt, begin, span));
      renew();
    }
    const double remaining = span - covered;
    const double allowed =
        known_limit > 0.0 ? known_limit : limit(loop, describe(loop, loop.last_dt, begin, span));
    known_limit = -1.0;
    last = remaining <= allowed * slack;
    const double dt = last ? remaining : remaining / std::ceil(remaining / (allowed * slack));
    const shoal_step step = describe(loop, dt, begin, span);
    for (StageRun& stage : loop.stages) run_stage(stage, step);
    covered += dt;
    loop.time = last ? begin + span : begin + covered;
    ++loop.steps;
    loop.last_dt = dt;
    loop.smallest_dt = std::min(loop.smallest_dt, dt);
    loop.largest_dt = std::max(loop.largest_dt, dt);
  }
}

// The largest step that a loop at the top asks for, cut to end at the target without a tiny last step.
double Stepper::outer_step(double target, double span) {
  double allowed = 0.0;
  for (LoopRun* loop : schedule_.top) {
    loop->limit = limit(*loop, describe(*loop, loop->last_dt, loop->time, loop->last_dt));
    // A loop without a limit follows the others.
    if (std::isfinite(loop->limit)) allowed = std::max(allowed, loop->limit);
  }
  const double remaining = target - time;
  if (schedule_.top.empty()) return remaining;
  if (!(allowed > 0.0)) allowed = span / steps_without_limit;
  if (remaining <= allowed * slack) return remaining;
  return remaining < 2.0 * allowed ? 0.5 * remaining : allowed;
}

void Stepper::step(double target, double span) {
  if (!(time < target)) return;
  const std::uint64_t begin = Stopwatch::now();
  executor_.stopwatch.start();
  if (schedule_.renews_in_outer_step) {
    exchange(outside(last_dt));
    renew();
  }
  const double dt = outer_step(target, span);
  const double end = dt == target - time ? target : time + dt;
  for (LoopRun* loop : schedule_.top) {
    cover(*loop, time, dt, loop->limit);
    loop->time = end;
  }
  time = end;
  ++outer_steps;
  last_dt = dt;
  check_health();
  step_ticks += Stopwatch::now() - begin;
}

void Stepper::collapse(const LoopRun& loop, const OperatorRun& op, const shoal_step& step,
                       double limit) const {
  char text[160];
  PhysicsFailure::Report report;
  if (limit > 0.0)
    std::snprintf(text, sizeof text,
                  "allows a step of only %.3g s, after steps of up to %.3g s: it has collapsed", limit,
                  loop.largest_dt);
  else
    std::snprintf(text, sizeof text, "allows a step of %.3g s, which is not a positive number", limit);
  report.cause = "operator " + op.attachment.name + " on body '" + op.body->name() + "' " + text;
  report.loop = loop.name;
  report.step = loop.steps;
  report.time = loop.time;

  // The particles that allow least, found in groups as long as a SIMD register may be.
  struct Group {
    double limit;
    std::uint64_t begin;
  };
  std::vector<Group> groups;
  const std::uint64_t n = op.body->n_owned();
  if ((op.c().flags & SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES) != 0)
    for (std::uint64_t begin = 0; begin < n; begin += SHOAL_PADDING) {
      const double allowed = executor_.time_step_of(op, step, begin, std::min(n, begin + SHOAL_PADDING));
      groups.push_back({std::isnan(allowed) ? -1.0 : allowed, begin});
    }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.limit < b.limit; });
  const Field* velocity = op.body->find("velocity");
  for (std::size_t k = 0; k < std::min<std::size_t>(groups.size(), 5); ++k) {
    std::uint64_t worst = groups[k].begin;
    double fastest = -1.0;
    for (std::uint64_t i = worst; velocity != nullptr && i < std::min(n, groups[k].begin + SHOAL_PADDING);
         ++i) {
      double square = 0.0;
      for (std::uint32_t c = 0; c < velocity->components(); ++c)
        square += std::pow(velocity->reals()[i * velocity->components() + c], 2);
      if (std::isnan(square)) square = std::numeric_limits<double>::infinity();
      if (square > fastest) fastest = square, worst = i;
    }
    report.worst.push_back(describe_particle(*op.body, worst, "time step", groups[k].limit));
  }
  throw PhysicsFailure(std::move(report));
}

}  // namespace shoal::kernel
