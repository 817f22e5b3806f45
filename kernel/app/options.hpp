// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the command line says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/app/console.hpp"

namespace shoal::kernel::app {

enum class Command { run, check, plan, study, report, describe, plugins, resume, schema };

struct Options {
  Command command = Command::run;
  ConsoleSettings console;
  std::vector<std::filesystem::path> plugin_paths;
  bool allow_plugin_paths = false;
  std::vector<std::string> settings;  ///< --set KEY=VALUE
  int threads = 0;                    ///< 0: all
  std::string case_file;              ///< run, check, plan, study
  std::filesystem::path folder;       ///< resume: of the results; report: of the studies
  std::optional<std::filesystem::path> output;
  bool force = false;
  bool strict = false;
  std::optional<std::string> until;  ///< a time with a unit
  std::optional<std::uint64_t> steps;
  std::string checkpoint_every;    ///< wall time, with a unit
  std::vector<std::string> types;  ///< describe
  std::vector<std::string> cases;  ///< report: cases and folders
  std::vector<std::string> vary;   ///< study: KEY=VALUE,VALUE,...
  std::string ensemble;            ///< study: KEY=VALUE,VALUE,...
  std::string want;                ///< study: error=1%
  bool limits = false;             ///< study, report: of all factors of time steps
  std::vector<std::string> limit;  ///< study: KEY, KEY=VALUE
  std::string within;              ///< study, report: wall time, with a unit
};

/// Reads the command line. Where it asks for help or is wrong, prints that and gives the exit code instead.
std::optional<int> read_command_line(int argc, char** argv, Options& options);

}  // namespace shoal::kernel::app
