// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/app/text.hpp"
#include "kernel/case/diagnostics.hpp"

namespace shoal::kernel::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

const PlanBody* find_body(const Plan& plan, const std::string& name) {
  for (const PlanBody& body : plan.bodies)
    if (body.name == name) return &body;
  return nullptr;
}

// A lattice has so many neighbours within the cut-off; what is known before lists are built.
double expected_neighbours(const Plan& plan, const PlanRelation& relation, int dimensions) {
  if (relation.mean_neighbours > 0.0) return relation.mean_neighbours;
  const PlanBody* other = find_body(plan, relation.neighbours);
  if (other == nullptr || other->spacing <= 0.0) return 0.0;
  // Of another body a particle sees at most the half space, and most see nothing.
  if (relation.body != relation.neighbours) return 0.0;
  const double q = relation.cutoff / other->spacing;
  return dimensions == 2 ? 3.14159265 * q * q : 4.18879 * q * q * q;
}

int dimensions_of(const Plan& plan) {
  for (const PlanBody& body : plan.bodies)
    for (const PlanField& field : body.fields)
      if (field.name == "position") return static_cast<int>(field.bytes_per_particle / 8);
  return 3;
}

std::string operator_line(const PlanOperator& op) {
  std::string line = op.name + "  on " + op.body;
  if (!op.neighbours.empty()) line += " with " + join(op.neighbours);
  std::vector<std::string> notes;
  if (op.on_demand) notes.emplace_back("on demand");
  if (op.limits_time_step) notes.emplace_back("limits the time step");
  if (op.serial) notes.emplace_back("serial");
  return notes.empty() ? line : line + "  (" + join(notes) + ")";
}

std::string fields_line(const PlanOperator& op) {
  std::vector<std::string> parts;
  if (!op.reads.empty()) parts.push_back("reads " + join(op.reads));
  if (!op.writes.empty()) parts.push_back("writes " + join(op.writes));
  if (!op.accumulates.empty()) parts.push_back("adds to " + join(op.accumulates));
  return join(parts, "; ");
}

void add_loop(const PlanLoop& loop, const std::string& indent, std::string& text);

void add_stage(const PlanStage& stage, const std::string& indent, std::string& text) {
  text += indent + stage.name + (stage.clears.empty() ? "" : "  (clears " + join(stage.clears) + ")") + "\n";
  for (const PlanOperator& op : stage.operators) {
    text += indent + "  " + operator_line(op) + "\n";
    if (const std::string fields = fields_line(op); !fields.empty())
      text += indent + "      " + fields + "\n";
  }
  for (const PlanLoop& loop : stage.loops) add_loop(loop, indent + "  ", text);
}

void add_loop(const PlanLoop& loop, const std::string& indent, std::string& text) {
  text += indent + "loop " + loop.name;
  if (loop.renews_neighbours) text += "  (neighbours renewed in each step)";
  if (loop.time_step_factor != 1.0)
    text += "  (time steps times " + significant(loop.time_step_factor, 4) + ")";
  text += "\n";
  for (const PlanStage& stage : loop.stages) add_stage(stage, indent + "  ", text);
}

std::string rank_text(shoal_rank rank, shoal_data_type type) {
  const char* words[] = {"scalar", "vector", "symmetric", "matrix", "array"};
  return type == SHOAL_INT64 ? "integer" : words[rank];
}

// Of a particle with n neighbours in a list that is not built yet: entries padded by four on average, what operators
// keep beside them, and the place and length of the row.
double expected_bytes(const PlanRelation& relation, double n) {
  return (4.0 + relation.kept_bytes_per_pair) * (n > 0.0 ? n + 4.0 : 0.0) + 12.0;
}

std::string relations_text(const Plan& plan) {
  Rows rows{{"neighbours", "configuration", "cut-off", "neighbours each", "bytes each"}};
  const int dimensions = dimensions_of(plan);
  for (const PlanRelation& relation : plan.relations) {
    const double n = expected_neighbours(plan, relation, dimensions);
    const bool built = relation.bytes_per_particle > 0.0;
    const std::string sign = built ? "" : "~";
    rows.push_back({relation.body + " - " + relation.neighbours,
                    relation.configuration == SHOAL_REFERENCE ? "reference" : "current",
                    significant(relation.cutoff, 4) + " m", n > 0.0 ? sign + fmt::format("{:.0f}", n) : "-",
                    built     ? fmt::format("{:.0f}", relation.bytes_per_particle)
                    : n > 0.0 ? fmt::format("~{:.0f}", expected_bytes(relation, n))
                              : "-"});
  }
  return rows.size() > 1 ? table(rows, 2, "  ") : "";
}

std::string body_text(const PlanBody& body) {
  std::string text = fmt::format("{}: {} particles, spacing {} m, smoothing length {} m ({}){}\n", body.name,
                                 count_text(body.particles), significant(body.spacing, 4),
                                 significant(body.smoothing_length, 4), body.smoothing_kernel,
                                 body.moves ? ", re-sorted as it moves" : "");
  Rows rows;
  std::uint64_t bytes = 0;
  for (const PlanField& field : body.fields) {
    rows.push_back({field.name, rank_text(field.rank, field.data_type), field.unit,
                    field.derived ? "derived" : "state", std::to_string(field.bytes_per_particle)});
    bytes += field.bytes_per_particle;
  }
  rows.push_back({"all fields", "", "", "", std::to_string(bytes) + " bytes per particle"});
  if (body.kept_bytes_per_particle > 0)
    rows.push_back({"records of operators", "", "", "", std::to_string(body.kept_bytes_per_particle)});
  return text + table(rows, 4, "    ");
}

double expected_list_bytes(const Plan& plan) {
  double bytes = 0.0;
  const int dimensions = dimensions_of(plan);
  for (const PlanRelation& relation : plan.relations) {
    const PlanBody* body = find_body(plan, relation.body);
    if (body == nullptr || relation.bytes_per_particle > 0.0) continue;
    const double n = expected_neighbours(plan, relation, dimensions);
    bytes += static_cast<double>(body->particles) * expected_bytes(relation, n);
  }
  return bytes;
}

}  // namespace

std::string plan_text(const Plan& plan) {
  std::string text;
  for (const PlanStage& stage : plan.outside) {
    text += stage.name == SHOAL_INITIAL ? "once, before the first step\n" : "before outputs and probes\n";
    add_stage(stage, "  ", text);
  }
  if (!plan.outer_step_renews.empty())
    text += "neighbours are renewed in each outer step (" + plan.outer_step_renews + ")\n";
  for (const PlanLoop& loop : plan.loops) add_loop(loop, "", text);
  if (const std::string relations = relations_text(plan); !relations.empty()) text += "\n" + relations;
  text += "\n";
  for (const PlanBody& body : plan.bodies) text += body_text(body);
  if (!plan.unscheduled.empty())
    text += "not computed, since nothing asks for it: " + join(plan.unscheduled) + "\n";
  for (const std::string& note : plan.notes) text += "note: " + note + "\n";
  const double bytes = static_cast<double>(plan.total_bytes) + expected_list_bytes(plan);
  text += fmt::format("\n{} particles; about {} of memory ({:.0f} bytes per particle)\n",
                      count_text(plan.particles), bytes_text(bytes),
                      plan.particles > 0 ? bytes / static_cast<double>(plan.particles) : 0.0);
  return text;
}

std::string bodies_text(const Plan& plan) {
  Rows rows;
  for (const PlanBody& body : plan.bodies)
    rows.push_back({body.name, count_text(body.particles) + " particles",
                    "spacing " + significant(body.spacing, 4) + " m"});
  return table(rows, 1, "  ");
}

std::string timings_text(const Summary& summary) {
  const Timings& t = summary.timings;
  if (t.steps <= 0.0) return "";
  const auto share = [&](double seconds) { return percent_text(seconds / t.steps); };
  const auto time = [](double seconds) { return fmt::format("{:.3f} s", seconds); };
  std::vector<OperatorTiming> operators = t.operators;
  std::stable_sort(operators.begin(), operators.end(),
                   [](const OperatorTiming& a, const OperatorTiming& b) { return a.seconds > b.seconds; });
  Rows rows{{"operator", "body", "loop", "calls", "time", "ns/pair", "ns/particle", "share"}};
  for (const OperatorTiming& op : operators) {
    if (op.calls == 0) continue;
    const double particles = static_cast<double>(op.particles);
    rows.push_back({op.name, op.body, op.loop, std::to_string(op.calls), time(op.seconds),
                    op.pairs > 0 ? fmt::format("{:.2f}", op.nanoseconds_per_pair()) : "",
                    particles > 0.0 ? fmt::format("{:.1f}", 1e9 * op.seconds / particles) : "",
                    share(op.seconds)});
  }
  rows.push_back({"neighbour search", "", "", std::to_string(t.renewals), time(t.neighbour_search), "", "",
                  share(t.neighbour_search)});
  rows.push_back({"overhead", "", "", "", time(t.overhead()), "", "", share(t.overhead())});
  rows.push_back({"all steps", "", "", std::to_string(summary.outer_steps), time(t.steps), "", "", ""});
  std::string text = table(rows, 3, "  ");
  for (const LoopTiming& loop : t.loops)
    text += fmt::format("  loop {}: {} steps, dt {} to {}{}\n", loop.name, loop.steps,
                        simulated_time_text(loop.smallest_dt), simulated_time_text(loop.largest_dt),
                        loop.limited_by.empty() ? "" : ", the last limited by " + loop.limited_by);
  for (const std::string& remark : t.remarks) text += "  " + remark + "\n";
  const double per_particle = summary.plan.particles > 0 ? static_cast<double>(summary.plan.total_bytes) /
                                                               static_cast<double>(summary.plan.particles)
                                                         : 0.0;
  return text + fmt::format(
                    "  {} particle-steps per second on {} thread{}; start {}, outputs {}, checkpoints {}\n"
                    "  peak memory {}, {:.0f} bytes per particle in fields and lists\n",
                    significant(particle_steps_per_second(summary.plan, t), 3), summary.threads,
                    summary.threads == 1 ? "" : "s", duration_text(summary.startup_seconds),
                    duration_text(summary.output_seconds), duration_text(summary.checkpoint_seconds),
                    bytes_text(static_cast<double>(summary.peak_memory)), per_particle);
}

std::string references_text(const std::vector<ReferenceResult>& results) {
  if (results.empty()) return "";
  Rows rows{{"reference", "against", "measure", "error", "tolerance", "verdict", ""}};
  for (const ReferenceResult& result : results) {
    rows.push_back({result.probe, result.source, result.measure, percent_text(result.error),
                    percent_text(result.tolerance), std::string(name_of(result.verdict)), result.remark});
  }
  return table(rows, 7, "  ");
}

std::string failure_text(const PhysicsFailure::Report& report) {
  std::string text = fmt::format("the physics failed at {} in step {} of loop {}: {}\n",
                                 simulated_time_text(report.time), report.step, report.loop, report.cause);
  if (report.worst.empty()) return text;
  Rows rows{{"body", "field", "id", "x", "y", "z", "value"}};
  for (const PhysicsFailure::Particle& p : report.worst)
    rows.push_back({p.body, p.field, std::to_string(p.id), significant(p.position[0], 6),
                    significant(p.position[1], 6), significant(p.position[2], 6), significant(p.value, 6)});
  return text + table(rows, 2, "  ");
}

}  // namespace shoal::kernel::app
