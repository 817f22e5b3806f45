// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// All that the program prints. Results go to the standard output; messages and the status line to the standard error.
// With --json every line of the standard output is an object with an "event".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace shoal::kernel::app {

struct ConsoleSettings {
  bool json = false;
  bool quiet = false;             ///< results and errors only
  std::string level = "warning";  ///< debug, info, warning, error
};

class Console {
 public:
  /// Takes the messages of kernel and plugins from now on.
  static void open(const ConsoleSettings& settings);

  static bool json();
  static bool quiet();
  /// Whether there is a terminal to draw a status line on.
  static bool has_status_line();

  /// Text of people; nothing with --json. A line end is added.
  static void print(std::string_view text);
  /// The same, but not with --quiet.
  static void inform(std::string_view text);
  /// A line for machines; nothing without --json.
  static void event(const nlohmann::json& object);
  /// What the command was asked for, also with --json: a schema, an object of one's own.
  static void raw(std::string_view text);

  /// Replaces the status line; an empty one clears it.
  static void status(const std::string& line);

  static void warning(std::string_view text);
  /// Formatted diagnostics and other texts of several lines, as they are.
  static void error(std::string_view text);
};

}  // namespace shoal::kernel::app
