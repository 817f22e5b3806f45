// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A program that runs beside this one, so that its failure, and its memory, are its own.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace shoal::kernel::app {

/// Path of this program.
std::filesystem::path this_program();

struct ProgramEnd {
  int code = 0;              ///< its exit code, or 128 + the signal that ended it
  bool out_of_time = false;  ///< whether it was asked to end
};

/// Runs a program with its output and errors in `log`, to its end; after `seconds` of wall time it gets SIGINT, once.
/// Throws std::system_error if it cannot be started, and OutputError if the log cannot be opened.
ProgramEnd run_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                       const std::filesystem::path& log,
                       double seconds = std::numeric_limits<double>::infinity());

/// The folder of PATH that holds a program, with its name; empty if there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace shoal::kernel::app
