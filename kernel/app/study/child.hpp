// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A program that runs beside this one, so that its failure, and its memory, are its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::kernel::app {

/// Path of this program.
std::filesystem::path this_program();

/// Runs a program to its end with its output and errors in `log`; gives its exit code, or 128 + the signal that ended
/// it. Throws std::system_error if it cannot be started, and OutputError if the log cannot be opened.
int run_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                const std::filesystem::path& log);

/// The folder of PATH that holds a program, with its name; empty if there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace shoal::kernel::app
