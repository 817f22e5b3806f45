// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/runner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/app/exit_code.hpp"
#include "kernel/app/interrupt.hpp"
#include "kernel/app/session.hpp"
#include "kernel/app/study/child.hpp"
#include "kernel/app/text.hpp"
#include "kernel/build_info.hpp"
#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel::app {
namespace {

bool has_checkpoint(const std::filesystem::path& results) {
  return std::filesystem::exists(results / "checkpoints") &&
         !std::filesystem::is_empty(results / "checkpoints");
}

bool is_done(const StudyResult& result) { return result.finished() || result.status == "failed"; }

}  // namespace

CaseRunner::CaseRunner(const Options& options, std::string text_of_case, double budget)
    : options_(options), text_of_case_(std::move(text_of_case)), budget_(budget) {}

// What the results of a run depend on; kept beside them.
std::string CaseRunner::key_of(const RunRequest& request) const {
  std::string key = std::string("shoal ") + std::string(build_info::version) + "\n";
  for (const std::string& setting : request.settings) key += "--set " + setting + "\n";
  return key + text_of_case_;
}

std::vector<std::string> CaseRunner::arguments(const RunRequest& request, bool resumes) const {
  std::vector<std::string> all{"resume", request.folder.string()};
  if (!resumes) {
    all = {"run", options_.case_file, "--output", request.folder.string(), "--force"};
    for (const std::string& setting : request.settings) all.insert(all.end(), {"--set", setting});
  }
  for (const auto& path : options_.plugin_paths) all.insert(all.end(), {"--plugin-path", path.string()});
  if (options_.allow_plugin_paths) all.emplace_back("--allow-plugin-paths");
  if (options_.threads > 0) all.insert(all.end(), {"--threads", std::to_string(options_.threads)});
  return all;
}

StudyResult CaseRunner::run(const RunRequest& request) {
  const std::filesystem::path key_file = request.folder.string() + ".key",
                              log = request.folder.string() + ".log";
  make_folder(request.folder.parent_path());
  const bool known = std::filesystem::exists(key_file) && std::filesystem::exists(request.folder);
  const bool same = known && read_whole_file(key_file) == key_of(request);
  if (known && !same && !options_.force)
    throw UserError(option_place(request.folder.string()),
                    "it holds results of another case, of other settings, or of another version",
                    {"choose another folder with --output, or replace them with --force"});
  const bool keep = same && !options_.force;
  StudyResult before = read_result(request.run, request.folder);
  const double earlier = keep ? before.wall_seconds : 0.0;
  if (keep && is_done(before)) {
    spent_ += earlier;
    Console::inform(fmt::format("{}{}  {} already", request.label, request.run.name, before.status));
    return before;
  }
  if (left() <= earlier) return note(request, exit_interrupted, true);
  write_atomically(key_file, key_of(request));
  Console::status(request.label + request.run.name);
  const ProgramEnd end = run_program(
      this_program(), arguments(request, keep && has_checkpoint(request.folder)), log, left() - earlier);
  Console::status("");
  return note(request, end.code, end.out_of_time);
}

StudyResult CaseRunner::note(const RunRequest& request, int code, bool out_of_time) {
  StudyResult result = read_result(request.run, request.folder);
  spent_ += result.wall_seconds;
  if (out_of_time && !is_done(result)) {
    result.out_of_time = true;
    result.status = result.reached > 0.0 ? "stopped at " + percent_text(result.reached) : "left out";
    result.why = duration_text(budget_) + " were over";
  }
  if (!result.finished() && result.why.empty())
    result.why = code == exit_interrupted
                     ? "interrupted"
                     : "exit code " + std::to_string(code) + ", see " + request.folder.string() + ".log";
  if (result.status == "running") result.status = "failed";  // it ended without a word: killed, out of memory
  std::string line = fmt::format("{}{}  {}", request.label, request.run.name, result.status);
  if (result.finished()) line += " in " + duration_text(result.wall_seconds);
  for (const StudyError& error : result.errors)
    if (result.finished()) line += fmt::format(", {} {}", error.probe, percent_text(error.error));
  Console::inform(line);
  Console::event({{"event", "study_run"},
                  {"run", request.run.name},
                  {"status", result.status},
                  {"wall_seconds", result.wall_seconds},
                  {"folder", request.folder.string()}});
  return result;
}

double read_budget(const Options& options) {
  return options.within.empty() ? std::numeric_limits<double>::infinity()
                                : read_time("--within", options.within);
}

}  // namespace shoal::kernel::app
