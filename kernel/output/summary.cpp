// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/summary.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace shoal::kernel {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json bodies(const Plan& plan) {
  Json list = Json::array();
  for (const PlanBody& body : plan.bodies) {
    list.push_back({{"name", body.name},
                    {"particles", body.particles},
                    {"spacing", body.spacing},
                    {"smoothing_length", body.smoothing_length},
                    {"moves", body.moves},
                    {"field_bytes", body.field_bytes},
                    {"list_bytes", body.list_bytes}});
  }
  return list;
}

Json loops(const Summary& summary) {
  Json list = Json::array();
  const double seconds = summary.timings.steps;
  for (const LoopTiming& loop : summary.timings.loops) {
    const double rate = seconds > 0.0 ? static_cast<double>(moving_particles(summary.plan)) *
                                            static_cast<double>(loop.steps) / seconds
                                      : 0.0;
    list.push_back({{"name", loop.name},
                    {"steps", loop.steps},
                    {"smallest_dt", number(loop.smallest_dt)},
                    {"largest_dt", number(loop.largest_dt)},
                    {"limited_by", loop.limited_by},
                    {"particle_steps_per_second", number(rate)}});
  }
  return list;
}

Json operators(const Timings& timings) {
  Json list = Json::array();
  for (const OperatorTiming& op : timings.operators) {
    list.push_back(
        {{"name", op.name},
         {"body", op.body},
         {"loop", op.loop},
         {"stage", op.stage},
         {"calls", op.calls},
         {"seconds", op.seconds},
         {"particles", op.particles},
         {"pairs", op.pairs},
         {"nanoseconds_per_pair", op.pairs > 0 ? number(op.nanoseconds_per_pair()) : Json(nullptr)},
         {"share", timings.steps > 0.0 ? number(op.seconds / timings.steps) : Json(nullptr)}});
  }
  return list;
}

Json references(const std::vector<ReferenceResult>& results) {
  Json list = Json::array();
  for (const ReferenceResult& result : results) {
    list.push_back({{"probe", result.probe},
                    {"column", result.column},
                    {"source", result.source},
                    {"measure", result.measure},
                    {"error", number(result.error)},
                    {"tolerance", result.tolerance},
                    {"verdict", result.verdict == Verdict::fail ? "fail" : name_of(result.verdict)},
                    {"points", result.points},
                    {"points_without_value", result.left_out},
                    {"remark", result.remark}});
  }
  return list;
}

Json costs(const Summary& summary) {
  const Timings& t = summary.timings;
  return {{"wall_seconds", summary.wall_seconds},
          {"earlier_wall_seconds", summary.earlier_wall_seconds},
          {"startup_seconds", summary.startup_seconds},
          {"steps_seconds", t.steps},
          {"operators_seconds", t.operators_total},
          {"neighbour_search_seconds", t.neighbour_search},
          {"overhead_seconds", t.overhead()},
          {"output_seconds", summary.output_seconds},
          {"checkpoint_seconds", summary.checkpoint_seconds},
          {"neighbour_renewals", t.renewals},
          {"neighbour_list_builds", t.list_builds},
          {"sorts", t.sorts},
          {"particle_steps_per_second", number(particle_steps_per_second(summary.plan, t))},
          {"peak_memory_bytes", summary.peak_memory},
          {"field_and_list_bytes_per_particle", summary.plan.particles > 0
                                                    ? number(static_cast<double>(summary.plan.total_bytes) /
                                                             static_cast<double>(summary.plan.particles))
                                                    : Json(nullptr)}};
}

}  // namespace

std::string to_json(const Summary& summary) {
  Json plugins = Json::array();
  for (const Summary::Plugin& plugin : summary.plugins)
    plugins.push_back({{"id", plugin.id}, {"version", plugin.version}, {"path", plugin.path}});
  const Json json{
      {"title", summary.title},
      {"case", summary.case_file},
      {"folder", summary.folder},
      {"status", summary.status},
      {"failure", summary.failure},
      {"finish_reason", summary.finish_reason},
      {"started", summary.started},
      {"shoal",
       {{"version", summary.version},
        {"compiler", summary.compiler},
        {"build_type", summary.build_type},
        {"flags", summary.flags}}},
      {"plugins", plugins},
      {"threads", summary.threads},
      {"dimensions", summary.dimensions},
      {"particles", summary.plan.particles},
      {"moving_particles", moving_particles(summary.plan)},
      {"bodies", bodies(summary.plan)},
      {"time", {{"start", summary.start_time}, {"reached", summary.time}, {"end", summary.end_time}}},
      {"outer_steps", summary.outer_steps},
      {"loops", loops(summary)},
      {"cost", costs(summary)},
      {"operators", operators(summary.timings)},
      {"remarks", summary.timings.remarks},
      {"references", references(summary.references)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::uint64_t moving_particles(const Plan& plan) {
  std::uint64_t moving = 0;
  for (const PlanBody& body : plan.bodies)
    if (body.moves) moving += body.particles;
  return moving > 0 ? moving : plan.particles;
}

double particle_steps_per_second(const Plan& plan, const Timings& timings) {
  std::uint64_t steps = 0;
  for (const LoopTiming& loop : timings.loops) steps = std::max(steps, loop.steps);
  return timings.steps > 0.0
             ? static_cast<double>(moving_particles(plan)) * static_cast<double>(steps) / timings.steps
             : 0.0;
}

std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

}  // namespace shoal::kernel
