// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Plan and timings of a run.
#include <algorithm>
#include <cmath>

#include "kernel/schedule/simulation_implementation.hpp"

namespace shoal::kernel {

namespace {

constexpr double nanosecond = 1e-9;

double seconds(std::uint64_t ticks) { return nanosecond * static_cast<double>(ticks); }

PlanOperator describe(const OperatorRun& op, const std::vector<std::unique_ptr<Body>>& bodies) {
  PlanOperator text;
  text.name = op.attachment.name;
  text.body = op.body->name();
  for (const shoal_relation_request& relation : op.attachment.relations)
    text.neighbours.push_back(bodies[relation.body]->name());
  for (const Access& access : op.attachment.accesses) {
    if (access.has(SHOAL_READ)) text.reads.push_back(access.field);
    if (access.has(SHOAL_WRITE)) text.writes.push_back(access.field);
    if (access.has(SHOAL_ACCUMULATE)) text.accumulates.push_back(access.field);
  }
  text.serial = (op.c().flags & SHOAL_OPERATOR_SERIAL) != 0;
  text.on_demand = op.attachment.on_demand();
  text.limits_time_step = op.c().time_step != nullptr;
  return text;
}

PlanLoop describe(const LoopRun& loop, const Schedule& schedule,
                  const std::vector<std::unique_ptr<Body>>& bodies);

PlanStage describe(const StageRun& stage, const Schedule& schedule,
                   const std::vector<std::unique_ptr<Body>>& bodies) {
  PlanStage text;
  text.name = stage.name;
  for (const BodyField& field : stage.clears)
    text.clears.push_back(field.body->name() + "." + field.field->name());
  for (const OperatorRun* op : stage.operators) text.operators.push_back(describe(*op, bodies));
  for (const LoopRun* loop : stage.loops) text.loops.push_back(describe(*loop, schedule, bodies));
  return text;
}

PlanLoop describe(const LoopRun& loop, const Schedule& schedule,
                  const std::vector<std::unique_ptr<Body>>& bodies) {
  PlanLoop text;
  text.name = loop.name;
  // A lone loop at the top is the outer step, whoever renews.
  text.renews_neighbours = loop.renews_neighbours || (schedule.renews_in_outer_step &&
                                                      schedule.top.size() == 1 && loop.parent == nullptr);
  text.time_step_factor = loop.factor;
  for (const StageRun& stage : loop.stages) text.stages.push_back(describe(stage, schedule, bodies));
  return text;
}

// What operators keep beside the list of a relation, for each of its entries.
std::uint32_t kept_bytes_per_pair(const Schedule& schedule, std::size_t relation) {
  std::uint32_t bytes = 0;
  for (const auto& op : schedule.operators)
    for (const std::uint32_t used : op->relations)
      if (used == relation) bytes += op->c().bytes_per_pair;
  return bytes;
}

std::uint64_t kept_bytes(const Relation& relation, std::uint32_t per_pair) {
  return relation.builds > 0 ? per_pair * relation.list.offsets()[relation.list.n_rows()] : 0;
}

PlanRelation describe(const Relation& relation, const std::vector<std::unique_ptr<Body>>& bodies,
                      std::uint32_t kept_bytes_per_pair) {
  PlanRelation text;
  text.kept_bytes_per_pair = kept_bytes_per_pair;
  const Body& body = *bodies[relation.body];
  text.body = body.name();
  text.neighbours = bodies[relation.neighbours]->name();
  text.configuration = relation.configuration;
  text.cutoff = relation.cutoff;
  text.builds = relation.builds;
  if (relation.builds > 0 && body.n_owned() > 0) {
    const auto n = static_cast<double>(body.n_owned());
    text.mean_neighbours = static_cast<double>(relation.list.n_pairs()) / n;
    text.bytes_per_particle =
        static_cast<double>(relation.bytes() + kept_bytes(relation, kept_bytes_per_pair)) / n;
  }
  return text;
}

PlanBody describe(const Body& body, const Neighbourhood& neighbourhood) {
  PlanBody text;
  text.name = body.name();
  text.smoothing_kernel = body.smoothing_kernel;
  text.particles = body.n_owned();
  text.halo_particles = body.n_halo();
  text.spacing = body.spacing;
  text.smoothing_length = body.smoothing_length;
  text.cutoff = body.cutoff;
  text.moves = body.sorted_as_it_moves;
  text.field_bytes = body.bytes();
  text.list_bytes = neighbourhood.bytes(body.index());
  for (const auto& field : body.fields()) {
    const FieldSpecification& known = field->specification();
    text.fields.push_back({known.name, known.unit, known.doc, known.rank, known.data_type,
                           static_cast<std::uint32_t>(field->bytes_per_particle()), field->derived,
                           field->declarers()});
  }
  return text;
}

}  // namespace

Plan Simulation::Implementation::plan() const {
  Plan plan;
  for (const StageRun* stage : {&schedule.initial, &schedule.sample})
    if (!stage->operators.empty()) plan.outside.push_back(describe(*stage, schedule, bodies));
  for (const LoopRun* loop : schedule.top) plan.loops.push_back(describe(*loop, schedule, bodies));
  plan.outer_step_renews = schedule.renews_in_outer_step ? schedule.outer_renewal : "";
  const std::vector<Relation>& relations = neighbourhood.relations();
  for (std::size_t k = 0; k < relations.size(); ++k)
    plan.relations.push_back(describe(relations[k], bodies, kept_bytes_per_pair(schedule, k)));
  for (const auto& body : bodies) {
    plan.bodies.push_back(describe(*body, neighbourhood));
    for (std::size_t k = 0; k < relations.size(); ++k)
      if (relations[k].body == body->index())
        plan.bodies.back().list_bytes += kept_bytes(relations[k], plan.relations[k].kept_bytes_per_pair);
    for (const auto& op : schedule.operators)
      for (const std::uint32_t used : op->relations)
        if (relations[used].neighbours == body->index())
          plan.bodies.back().kept_bytes_per_particle += op->c().bytes_per_particle;
    plan.particles += body->n_owned();
    plan.total_bytes += plan.bodies.back().field_bytes + plan.bodies.back().list_bytes +
                        plan.bodies.back().kept_bytes_per_particle * body->n_owned();
  }
  plan.unscheduled = schedule.unscheduled;
  plan.notes = declarations.notes;
  return plan;
}

Timings Simulation::Implementation::timings() const {
  Timings timings;
  std::uint64_t operator_ticks = 0, outside_ticks = renewal_ticks_before_steps;
  for (const auto& op : schedule.operators) {
    timings.operators.push_back({op->attachment.name, op->body->name(), op->loop, op->stage, op->calls,
                                 op->particles, op->pairs, seconds(op->ticks)});
    // The stages outside the loops are outside the steps too.
    if (schedule.find_loop(op->loop) != nullptr) operator_ticks += op->ticks;
    if (op->loop == SHOAL_INITIAL || op->loop == SHOAL_SAMPLE) outside_ticks += op->ticks;
  }
  for (const auto& op : schedule.operators) {
    char text[512] = "";
    if (op->c().remark != nullptr) op->c().remark(op->c().self, text, sizeof text);
    if (text[0] != '\0') timings.remarks.emplace_back(text);
  }
  for (const auto& loop : schedule.loops)
    timings.loops.push_back({loop->name, loop->steps, loop->steps > 0 ? loop->smallest_dt : 0.0,
                             loop->largest_dt, loop->last_dt,
                             loop->limited_by != nullptr ? loop->limited_by->attachment.name : ""});
  timings.steps = seconds(stepper.step_ticks);
  timings.operators_total = seconds(operator_ticks);
  timings.neighbour_search = seconds(stepper.renewal_ticks);
  timings.outside_steps = seconds(outside_ticks);
  timings.sort = seconds(neighbourhood.sort_ticks);
  timings.halo = seconds(neighbourhood.halo_ticks);
  timings.lists = seconds(neighbourhood.list_ticks);
  timings.halo_values = seconds(executor.image_ticks);
  timings.clear = seconds(executor.clear_ticks);
  timings.health = seconds(stepper.health_ticks);
  timings.renewals = neighbourhood.renewals;
  timings.sorts = neighbourhood.sorts;
  timings.list_builds = neighbourhood.list_builds;
  return timings;
}

}  // namespace shoal::kernel
