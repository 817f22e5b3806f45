// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything that is wrong with a case is collected here and shown at once, sorted by place, with the line, a
// caret, and a way to mend it.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/case/place.hpp"

namespace shoal::kernel {

enum class Severity { error, warning };

struct Diagnostic {
  Severity severity = Severity::error;
  Place place;
  std::string message;             ///< one sentence, without a full stop
  std::vector<std::string> notes;  ///< further lines: valid keys, an example, the other place
};

class Diagnostics {
 public:
  static constexpr std::size_t default_limit = 20;

  void error(const Place& place, std::string message, std::vector<std::string> notes = {});
  void warning(const Place& place, std::string message, std::vector<std::string> notes = {});
  void append(const Diagnostics& other);

  bool has_errors() const { return n_errors_ > 0; }
  bool empty() const { return items_.empty(); }
  std::size_t n_errors() const { return n_errors_; }
  std::size_t n_warnings() const { return items_.size() - n_errors_; }

  /// By text in the order in which texts were first complained about, then by line and column.
  std::vector<Diagnostic> sorted() const;

  /// At most `limit` messages (warnings are left out before errors) and how many there are beyond.
  std::string format(std::size_t limit = default_limit) const;

  /// Throws UserError if there is an error.
  void throw_if_errors() const;

 private:
  void add(Diagnostic item);
  std::vector<Diagnostic> items_;
  std::size_t n_errors_ = 0;
};

/// One message with its line and caret; ends in a line end.
std::string format(const Diagnostic& item);

/// What the user asked for is wrong. `what()` is the formatted text.
class UserError : public std::runtime_error {
 public:
  explicit UserError(Diagnostics diagnostics);
  UserError(const Place& place, const std::string& message, std::vector<std::string> notes = {});
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  Diagnostics diagnostics_;
};

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that `word` is likely a misspelling of: at most two edits and a third of its length, another
/// case, the last part of a dotted name, or the only one that begins with it. Empty if there is none.
std::string closest(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean 'viscosity'?" or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// "'a' or 'b'", "'a', 'b' or 'c'"
std::string quoted_alternatives(const std::vector<std::string>& words);

/// Columns that a terminal needs for the text; tabs count as one (messages replace them by spaces).
int display_width(std::string_view utf8);

/// Number of characters (code points).
int count_characters(std::string_view utf8);

}  // namespace shoal::kernel
