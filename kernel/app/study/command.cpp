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
#include "kernel/app/study/ensemble.hpp"
#include "kernel/app/study/files.hpp"
#include "kernel/app/study/limits.hpp"
#include "kernel/app/text.hpp"
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
    CaseRunner runner(options_, text_of_case_, read_budget(options_));
    for (std::size_t k = 0; k < runs_.size() && !interrupted(); ++k) {
      study_.results.push_back(runner.run(request_of(k)));
      if (!study_.results.back().finished())
        Console::warning(runs_[k].name + ": " + study_.results.back().why);
    }
    write();
    find_limits();
    tell();
    if (interrupted()) return exit_interrupted;
    if (options_.strict && misses_a_reference()) return exit_physics_failed;
    const bool all = std::all_of(study_.results.begin(), study_.results.end(), [](const StudyResult& result) {
      return result.finished() || result.out_of_time;
    });
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
    const std::vector<StepFactor> declared = declared_step_factors(session.model());
    if (options_.limits) factors_ = declared;
    for (const std::string& text : options_.limit) factors_.push_back(read_step_factor(text, declared));
    limit_settings_ = session.model().limits;
    study_.title = session.model().title.empty() ? case_name(options_.case_file) : session.model().title;
    for (const std::string& text : options_.vary.empty() ? session.model().study : options_.vary)
      study_.variations.push_back(read_variation("--vary", text));
    const std::string ensemble =
        options_.ensemble.empty() ? session.model().ensemble.value_or("") : options_.ensemble;
    if (ensemble.empty()) return;
    const Variation chance = read_variation("--ensemble", ensemble);
    for (const Variation& varied : study_.variations)
      if (varied.key == chance.key)
        throw UserError(option_place("<--ensemble " + ensemble + ">"),
                        "'" + chance.key + "' is varied already: a mean is over runs that agree in all else",
                        {"take it out of --vary, or of 'study' in the case"});
    runs_of_a_mean_ = chance.values.size();
    study_.variations.push_back(chance);  // the last changes fastest: the runs of a mean are neighbours
  }

  // Every combination is checked before the first one runs.
  void check() const {
    for (const StudyRun& run : runs_) {
      Options options = options_;
      options.settings = settings(run);
      const Session session(options, options.case_file, true);
    }
    if (factors_.empty()) return;
    Options options = options_;
    options.settings = settings_for_limits();
    for (const StepFactor& factor : factors_)
      options.settings.push_back(factor.key + "=" + significant(factor.standard, 4));
    const Session session(options, options.case_file, true);
  }

  RunRequest request_of(std::size_t k) const {
    return {runs_[k], settings(runs_[k]), folder_ / "runs" / runs_[k].name,
            fmt::format("{}/{}  ", k + 1, runs_.size())};
  }

  // Of the first combination, which is to be the cheapest, and as the case asks for where the command line does not.
  std::vector<std::string> settings_for_limits() const {
    std::vector<std::string> all = settings(runs_[0]);
    for (const std::string& setting : limit_settings_) {
      const std::string key = setting.substr(0, setting.find('=') + 1);
      if (std::none_of(options_.settings.begin(), options_.settings.end(),
                       [&](const std::string& own) { return own.starts_with(key); }))
        all.push_back(setting);
    }
    return all;
  }

  void find_limits() {
    if (factors_.empty()) return;
    RunRequest standard = request_of(0);
    standard.label = "limit  ";
    standard.settings = settings_for_limits();
    if (standard.settings != settings(runs_[0]))
      standard = {{"default", {}}, standard.settings, folder_ / "limits" / "default", "limit  "};
    CaseRunner runner(options_, text_of_case_, read_budget(options_));
    limits_ = app::find_limits(runner, factors_, standard, folder_ / "limits");
    write_atomically(folder_ / "limits.csv", limits_csv(limits_));
  }

  std::vector<std::string> keys_beside_ensemble() const {
    std::vector<std::string> keys;
    for (const Variation& variation : study_.variations) keys.push_back(variation.key);
    keys.pop_back();
    return keys;
  }

  void find_means() {
    if (runs_of_a_mean_ == 0) return;
    for (std::size_t first = 0; first < study_.results.size(); first += runs_of_a_mean_) {
      Options options = options_;
      options.settings = settings(runs_[first]);
      Session session(options, options.case_file, true);
      std::vector<std::filesystem::path> folders;
      for (std::size_t k = first; k < std::min(first + runs_of_a_mean_, study_.results.size()); ++k)
        if (study_.results[k].finished()) folders.push_back(request_of(k).folder);
      const std::vector<std::string> names = error_names(study_);
      const std::vector<ReferenceSpecification>& references = session.recorder().references();
      for (std::size_t e = 0; e < std::min(references.size(), names.size()); ++e) {
        EnsembleMean mean{runs_[first].values, names[e], folders.size(), runs_of_a_mean_, {}};
        mean.values.pop_back();
        std::vector<std::filesystem::path> tables;
        for (const auto& folder : folders) tables.push_back(probe_table(folder, references[e].probe));
        mean.result = compare_ensemble_files(references[e], tables);
        if (folders.size() < runs_of_a_mean_) mean.result.verdict = Verdict::incomplete;
        means_.push_back(std::move(mean));
      }
    }
    write_atomically(folder_ / "ensemble.csv", ensemble_csv(keys_beside_ensemble(), means_));
  }

  bool misses_a_reference() const {
    if (runs_of_a_mean_ > 0)
      return std::any_of(means_.begin(), means_.end(),
                         [](const EnsembleMean& mean) { return mean.result.verdict == Verdict::fail; });
    for (const StudyResult& result : study_.results)
      for (const StudyError& error : result.errors)
        if (result.finished() && !(error.error <= error.tolerance)) return true;
    return false;
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
    find_means();
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
    const ProgramEnd end = run_program(
        "/bin/sh", {"-c", "cd \"$1\" && exec \"$2\" study.gnuplot", "sh", folder_.string(), gnuplot.string()},
        folder_ / "gnuplot.log");
    if (end.code != 0) Console::warning("gnuplot failed; see " + (folder_ / "gnuplot.log").string());
  }

  void tell() const {
    std::string text = study_.title + "\n" + study_table(study_);
    const std::vector<std::string> names = error_names(study_);
    if (names.empty())
      text += "The case has no reference, so there is no error to compare.\n";
    else
      text += "* no other run has a smaller " + names[study_.chosen] + " error in less time\n";
    if (!means_.empty()) text += ensemble_table(keys_beside_ensemble(), means_);
    if (wish_ && !names.empty()) {
      const auto best = cheapest(study_.results, study_.chosen, wish_->error);
      text +=
          best ? fmt::format("cheapest with {} within {}: {} ({}, error {})\n", names[study_.chosen],
                             percent_text(wish_->error), study_.results[*best].run.name,
                             duration_text(study_.results[*best].wall_seconds),
                             percent_text(study_.results[*best].errors[study_.chosen].error))
               : fmt::format("no run has {} within {}\n", names[study_.chosen], percent_text(wish_->error));
    }
    if (!limits_.empty()) text += limits_table(limits_);
    Console::print(text + "results in " + folder_.string());
    Console::event({{"event", "study"}, {"folder", folder_.string()}, {"text", text}});
  }

  const Options& options_;
  std::optional<Wish> wish_;
  Study study_;
  std::vector<StudyRun> runs_;
  std::size_t runs_of_a_mean_ = 0;  // 0: there is no ensemble
  std::vector<EnsembleMean> means_;
  std::filesystem::path folder_;
  std::string text_of_case_;
  std::vector<StepFactor> factors_;
  std::vector<std::string> limit_settings_;
  std::vector<Limit> limits_;
};

}  // namespace

int study_case(const Options& options) { return StudyDriver(options).drive(); }

}  // namespace shoal::kernel::app
