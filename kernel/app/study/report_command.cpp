// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// shoal report: studies cases, each as it says itself, and writes what came out. Studies that have run are taken as
// they are, so that a report that was stopped goes on.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "kernel/app/commands.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/app/interrupt.hpp"
#include "kernel/app/report.hpp"
#include "kernel/app/session.hpp"
#include "kernel/app/study/child.hpp"
#include "kernel/app/study/page.hpp"
#include "kernel/build_info.hpp"
#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel::app {
namespace {

bool is_case(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

// Cases in the order of their names; a folder stands for all below it.
std::vector<std::filesystem::path> find_cases(const std::vector<std::string>& asked) {
  std::vector<std::filesystem::path> cases;
  for (const std::string& text : asked) {
    if (!std::filesystem::is_directory(text)) {
      if (!std::filesystem::exists(text))
        throw UserError(option_place(text), "there is no such case or folder");
      cases.emplace_back(text);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(text))
      if (entry.is_regular_file() && is_case(entry.path())) cases.push_back(entry.path());
  }
  std::sort(cases.begin(), cases.end());
  cases.erase(std::unique(cases.begin(), cases.end()), cases.end());
  return cases;
}

// The comment at the head of a case, without licence lines.
std::string head_comment(const std::string& text) {
  std::istringstream lines(text);
  std::string comment;
  for (std::string line; std::getline(lines, line) && line.starts_with("#");) {
    if (line.find("SPDX-") != std::string::npos) continue;
    const auto begin = line.find_first_not_of("# ");
    if (begin != std::string::npos) comment += (comment.empty() ? "" : " ") + line.substr(begin);
  }
  return comment;
}

std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1);
  std::string cell;
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '"' && quoted && k + 1 < text.size() && text[k + 1] == '"') {
      cell += '"';
      ++k;
    } else if (c == '"') {
      quoted = !quoted;
    } else if ((c == ',' || c == '\n') && !quoted) {
      rows.back().push_back(std::move(cell));
      cell.clear();
      if (c == '\n' && k + 1 < text.size()) rows.emplace_back();
    } else {
      cell += c;
    }
  }
  return rows;
}

MachineReport this_machine(const Options& options) {
  MachineReport machine;
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      machine.processor = line.substr(line.find(':') + 2);
      break;
    }
  machine.cores = std::thread::hardware_concurrency();
  machine.threads = options.threads > 0 ? options.threads : static_cast<int>(machine.cores);
  machine.version = fmt::format("{} ({}, {})", build_info::version, build_info::compiler, build_info::flags);
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%d", &parts);
  machine.date = date;
  machine.within = options.within;
  return machine;
}

void describe(const Options& options, CaseReport& report) {
  report.what = head_comment(read_whole_file(report.case_file));
  Session session(options, report.case_file.string(), true);
  report.title = session.model().title.empty() ? report.name : session.model().title;
  for (const LoadedPlugin* plugin : session.workshop().loader.loaded())
    report.plugins += (report.plugins.empty() ? "" : ", ") + plugin->id + " " + plugin->version_text;
  report.plan = plan_text(session.run().plan());
}

void study(const Options& options, const std::filesystem::path& results, CaseReport& report) {
  std::vector<std::string> arguments{"study", report.case_file.string(), "--output", results.string()};
  for (const auto& path : options.plugin_paths)
    arguments.insert(arguments.end(), {"--plugin-path", path.string()});
  if (options.threads > 0) arguments.insert(arguments.end(), {"--threads", std::to_string(options.threads)});
  if (options.force) arguments.emplace_back("--force");
  if (options.limits) arguments.emplace_back("--limits");
  if (!options.within.empty()) arguments.insert(arguments.end(), {"--within", options.within});
  make_folder(results.parent_path());
  const std::filesystem::path log = results.string() + ".log";
  const int code = run_program(this_program(), arguments, log).code;
  if (code != exit_done && code != exit_interrupted)
    report.failure = fmt::format("The study ended with exit code {} ({}).", code,
                                 code == exit_physics_failed ? "a run failed" : "see " + log.string());
  if (!std::filesystem::exists(results / "study.csv")) return;
  report.table = read_csv(read_whole_file(results / "study.csv"));
  if (std::filesystem::exists(results / "ensemble.csv"))
    report.means = read_csv(read_whole_file(results / "ensemble.csv"));
  if (options.limits && std::filesystem::exists(results / "limits.csv"))
    report.limits = read_csv(read_whole_file(results / "limits.csv"));
  for (const char* picture : {"error_against_spacing", "error_against_time"}) {
    const std::filesystem::path file = results / (std::string(picture) + ".svg");
    if (std::filesystem::exists(file)) report.pictures.emplace_back(picture, read_whole_file(file));
  }
}

void write_pages(const Options& options, const std::vector<CaseReport>& reports) {
  const std::filesystem::path folder = options.output.value_or("docs/report");
  make_folder(folder);
  const MachineReport machine = this_machine(options);
  for (const CaseReport& report : reports)
    for (const auto& [name, svg] : report.pictures)
      write_atomically(folder / picture_file(report, name), svg);
  write_atomically(folder / "report.md", markdown_page(machine, reports));
  write_atomically(folder / "report.html", html_page(machine, reports));
  Console::print(fmt::format("{} cases in {} and report.html beside it", reports.size(),
                             (folder / "report.md").string()));
}

}  // namespace

int write_report(const Options& options) {
  const std::vector<std::filesystem::path> cases =
      find_cases(options.cases.empty() ? std::vector<std::string>{"cases"} : options.cases);
  if (cases.empty())
    throw UserError(option_place(options.cases.empty() ? "cases" : options.cases[0]),
                    "there is no case in it");
  const std::filesystem::path results = options.folder.empty() ? "results/report" : options.folder;
  watch_interrupts();
  std::vector<CaseReport> reports;
  for (std::size_t k = 0; k < cases.size() && !interrupted(); ++k) {
    CaseReport report;
    report.case_file = cases[k];
    report.name = cases[k].stem().string();
    report.area = std::filesystem::absolute(cases[k]).parent_path().filename().string();
    describe(options, report);
    Console::status(fmt::format("{}/{}  {}/{}", k + 1, cases.size(), report.area, report.name));
    study(options, results / (report.area + "_" + report.name), report);
    Console::status("");
    Console::inform(fmt::format("{}/{}  {}/{}  {}", k + 1, cases.size(), report.area, report.name,
                                report.failure.empty() ? "done" : report.failure));
    reports.push_back(std::move(report));
  }
  write_pages(options, reports);
  if (interrupted()) return exit_interrupted;
  const bool good = std::all_of(reports.begin(), reports.end(),
                                [](const CaseReport& report) { return report.failure.empty(); });
  return good ? exit_done : exit_physics_failed;
}

}  // namespace shoal::kernel::app
