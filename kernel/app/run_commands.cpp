// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// run, resume, check and plan.
#include <tbb/global_control.h>

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "kernel/app/commands.hpp"
#include "kernel/app/driver.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/app/interrupt.hpp"
#include "kernel/app/report.hpp"
#include "kernel/app/text.hpp"

namespace shoal::kernel::app {
namespace {

// Also for what computes outside of the simulation: probes, outputs.
std::optional<tbb::global_control> limit_threads(const Options& options) {
  std::optional<tbb::global_control> control;
  if (options.threads > 0)
    control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  return control;
}

std::filesystem::path results_of(const Options& options) {
  return options.output ? *options.output : std::filesystem::path("results") / case_name(options.case_file);
}

}  // namespace

int run_case(const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::filesystem::path folder = results_of(options);
  ResultFolder::check_free(folder, options.force);
  const auto threads = limit_threads(options);
  Session session(options, options.case_file, false);
  watch_interrupts();
  Driver driver(options, session, ResultFolder::make(folder, options.force), begin);
  driver.start();
  return driver.drive();
}

int resume_case(const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  ResultFolder folder = ResultFolder::reopen(options.folder);
  const auto threads = limit_threads(options);
  Session session(options, folder.case_file().string(), true);
  watch_interrupts();
  Driver driver(options, session, std::move(folder), begin);
  driver.resume();
  return driver.drive();
}

int check_case_file(const Options& options) {
  const auto threads = limit_threads(options);
  Session session(options, options.case_file, true);
  const Plan plan = session.run().plan();
  Console::print(fmt::format("{} is good: {} bod{}, {} particles", options.case_file, plan.bodies.size(),
                             plan.bodies.size() == 1 ? "y" : "ies", count_text(plan.particles)));
  Console::event({{"event", "check"}, {"case", options.case_file}, {"particles", plan.particles}});
  return exit_done;
}

int plan_case(const Options& options) {
  const auto threads = limit_threads(options);
  Session session(options, options.case_file, true);
  const Plan plan = session.run().plan();
  std::string text = session.model().title.empty() ? "" : session.model().title + "\n";
  text += "plugins:";
  for (const LoadedPlugin* plugin : session.workshop().loader.loaded())
    text += " " + plugin->id + " " + plugin->version_text;
  text += fmt::format("\nruns to {}\n\n", simulated_time_text(session.run().end_time())) + plan_text(plan);
  Console::print(text);
  Console::event({{"event", "plan"},
                  {"particles", plan.particles},
                  {"bytes", plan.total_bytes},
                  {"loops", session.run().loop_names()},
                  {"unscheduled", plan.unscheduled},
                  {"text", text}});
  return exit_done;
}

}  // namespace shoal::kernel::app
