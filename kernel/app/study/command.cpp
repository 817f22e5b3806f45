// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// shoal study: runs a case in all combinations of some values, each run in a process of its own, and says what error
// costs what. A study that was stopped goes on where it was; a run that fails is a line of the table.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kernel/app/commands.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/app/interrupt.hpp"
#include "kernel/app/session.hpp"
#include "kernel/app/study/child.hpp"
#include "kernel/app/study/files.hpp"
#include "kernel/app/text.hpp"
#include "kernel/build_info.hpp"
#include "kernel/case/overrides.hpp"
#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel::app {
namespace {

// --want PROBE=1% or --want error=1%
struct Wish {
  std::string probe;  // empty: the first reference
  double error = 0.0;
};

std::optional<Wish> read_wish(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos || name.empty())
    throw UserError(option_place("<--want " + text + ">"), "it does not say what error is wanted",
                    {"for example: --want error=1%, or --want PROBE=1%"});
  Diagnostics diagnostics;
  const Node node =
      read_yaml_value(text.substr(equals + 1), option_place("<--want " + text + ">"), diagnostics);
  const std::optional<double> value = read_number(node, NumberRequest{"1", false}, Parameters{}, diagnostics);
  diagnostics.throw_if_errors();
  return Wish{name == "error" ? "" : name, value.value_or(0.0)};
}

class StudyDriver {
 public:
  explicit StudyDriver(const Options& options) : options_(options), wish_(read_wish(options.want)) {
    folder_ = options.output ? *options.output
                             : std::filesystem::path("results") / (case_name(options.case_file) + "_study");
    text_of_case_ = read_whole_file(options.case_file);
    read_case();
    runs_ = matrix(study_.variations);
  }

  int drive() {
    check();
    watch_interrupts();
    make_folder(folder_);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (interrupted()) break;
      run(runs_[k], k);
    }
    write();
    tell();
    if (interrupted()) return exit_interrupted;
    const bool all = std::all_of(study_.results.begin(), study_.results.end(),
                                 [](const StudyResult& result) { return result.finished(); });
    return all ? exit_done : exit_physics_failed;
  }

 private:
  std::vector<std::string> settings(const StudyRun& run) const {
    std::vector<std::string> all = options_.settings;
    for (std::size_t k = 0; k < study_.variations.size(); ++k)
      all.push_back(study_.variations[k].key + "=" + run.values[k]);
    return all;
  }

  void read_case() {
    const Session session(options_, options_.case_file, true);
    study_.title = session.model().title.empty() ? case_name(options_.case_file) : session.model().title;
    for (const std::string& text : options_.vary.empty() ? session.model().study : options_.vary)
      study_.variations.push_back(read_variation(text));
  }

  // Every combination is checked before the first one runs.
  void check() const {
    for (const StudyRun& run : runs_) {
      Options options = options_;
      options.settings = settings(run);
      const Session session(options, options.case_file, true);
    }
  }

  std::filesystem::path folder_of(const StudyRun& run) const { return folder_ / "runs" / run.name; }

  // What the results of a run depend on; kept beside them.
  std::string key_of(const StudyRun& run) const {
    std::string key = std::string("shoal ") + std::string(build_info::version) + "\n";
    for (const std::string& setting : settings(run)) key += "--set " + setting + "\n";
    return key + text_of_case_;
  }

  void run(const StudyRun& run, std::size_t number) {
    const std::filesystem::path results = folder_of(run), key_file = results.string() + ".key",
                                log = results.string() + ".log";
    make_folder(results.parent_path());
    const bool known = std::filesystem::exists(key_file) && std::filesystem::exists(results);
    const bool same = known && read_whole_file(key_file) == key_of(run);
    if (known && !same && !options_.force)
      throw UserError(option_place(results.string()),
                      "it holds results of another case, of other settings, or of another version",
                      {"choose another folder with --output, or replace them with --force"});
    const StudyResult before = read_result(run, results);
    if (same && !options_.force && (before.finished() || before.status == "failed")) {
      Console::inform(
          fmt::format("{}/{}  {}  {} already", number + 1, runs_.size(), run.name, before.status));
      study_.results.push_back(before);
      return;
    }
    std::vector<std::string> arguments{"run", options_.case_file, "--output", results.string(), "--force"};
    if (same && !options_.force && has_checkpoint(results)) arguments = {"resume", results.string()};
    if (arguments[0] == "run")
      for (const std::string& setting : settings(run)) arguments.insert(arguments.end(), {"--set", setting});
    add_common(arguments);
    write_atomically(key_file, key_of(run));
    Console::status(fmt::format("{}/{}  {}", number + 1, runs_.size(), run.name));
    const int code = run_program(this_program(), arguments, log);
    Console::status("");
    note_result(run, number, code, log);
  }

  void add_common(std::vector<std::string>& arguments) const {
    for (const auto& path : options_.plugin_paths)
      arguments.insert(arguments.end(), {"--plugin-path", path.string()});
    if (options_.allow_plugin_paths) arguments.emplace_back("--allow-plugin-paths");
    if (options_.threads > 0)
      arguments.insert(arguments.end(), {"--threads", std::to_string(options_.threads)});
  }

  static bool has_checkpoint(const std::filesystem::path& results) {
    return std::filesystem::exists(results / "checkpoints") &&
           !std::filesystem::is_empty(results / "checkpoints");
  }

  void note_result(const StudyRun& run, std::size_t number, int code, const std::filesystem::path& log) {
    StudyResult result = read_result(run, folder_of(run));
    if (!result.finished() && result.why.empty())
      result.why = code == exit_interrupted ? "interrupted"
                                            : "exit code " + std::to_string(code) + ", see " + log.string();
    if (result.status == "running")
      result.status = "failed";  // it ended without a word: killed, out of memory
    std::string line = fmt::format("{}/{}  {}  {}", number + 1, runs_.size(), run.name, result.status);
    if (result.finished()) line += " in " + duration_text(result.wall_seconds);
    for (const StudyError& error : result.errors)
      if (result.finished()) line += fmt::format(", {} {}", error.probe, percent_text(error.error));
    Console::inform(line);
    if (!result.finished()) Console::warning(run.name + ": " + result.why);
    Console::event({{"event", "study_run"},
                    {"run", run.name},
                    {"status", result.status},
                    {"wall_seconds", result.wall_seconds},
                    {"folder", folder_of(run).string()}});
    study_.results.push_back(std::move(result));
  }

  void choose_error() {
    if (!wish_ || wish_->probe.empty()) return;
    const auto names = error_names(study_);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k].substr(0, names[k].rfind(' ')) == wish_->probe) {
        study_.chosen = k;
        return;
      }
    std::string known;
    for (const std::string& name : names)
      known += (known.empty() ? "" : ", ") + name.substr(0, name.rfind(' '));
    Console::warning("--want: no reference of this case is of a probe '" + wish_->probe +
                     "' (there are: " + known + ")");
    wish_.reset();
  }

  void write() {
    study_.refined = refined_variation(study_.results, study_.variations.size());
    choose_error();
    write_atomically(folder_ / "study.csv", study_csv(study_));
    const std::string script = study_plot(study_);
    if (script.empty()) return;
    write_atomically(folder_ / "study.gnuplot", script);
    const std::filesystem::path gnuplot = find_program("gnuplot");
    if (gnuplot.empty()) {
      Console::warning(
          "no pictures: there is no gnuplot (apt-get install gnuplot-nox; then gnuplot study.gnuplot in " +
          folder_.string() + ")");
      return;
    }
    const int code = run_program(
        "/bin/sh", {"-c", "cd \"$1\" && exec \"$2\" study.gnuplot", "sh", folder_.string(), gnuplot.string()},
        folder_ / "gnuplot.log");
    if (code != 0) Console::warning("gnuplot failed; see " + (folder_ / "gnuplot.log").string());
  }

  void tell() const {
    std::string text = study_.title + "\n" + study_table(study_);
    const std::vector<std::string> names = error_names(study_);
    if (names.empty())
      text += "The case has no reference, so there is no error to compare.\n";
    else
      text += "* no other run has a smaller " + names[study_.chosen] + " error in less time\n";
    if (wish_ && !names.empty()) {
      const auto best = cheapest(study_.results, study_.chosen, wish_->error);
      text +=
          best ? fmt::format("cheapest with {} within {}: {} ({}, error {})\n", names[study_.chosen],
                             percent_text(wish_->error), study_.results[*best].run.name,
                             duration_text(study_.results[*best].wall_seconds),
                             percent_text(study_.results[*best].errors[study_.chosen].error))
               : fmt::format("no run has {} within {}\n", names[study_.chosen], percent_text(wish_->error));
    }
    Console::print(text + "results in " + folder_.string());
    Console::event({{"event", "study"}, {"folder", folder_.string()}, {"text", text}});
  }

  const Options& options_;
  std::optional<Wish> wish_;
  Study study_;
  std::vector<StudyRun> runs_;
  std::filesystem::path folder_;
  std::string text_of_case_;
};

}  // namespace

int study_case(const Options& options) { return StudyDriver(options).drive(); }

}  // namespace shoal::kernel::app
