// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The text of a case before and beside yaml-cpp: its lines, positions in characters, what yaml-cpp would misread, and
// its messages in words for people who do not know its grammar.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/place.hpp"

namespace shoal::kernel {

/// A text with equal line ends and without byte order mark.
class YamlSource {
 public:
  /// `fixed`: the place of everything, for a text that stands in no file.
  YamlSource(std::string text, const std::string& name, std::optional<Place> fixed);

  const std::string& text() const { return text_; }
  const std::vector<std::string>& lines() const { return source_->lines; }
  /// Line and column in bytes, from 0, as yaml-cpp counts.
  Place place(int line, int column, int bytes) const;
  Place whole() const { return fixed_ ? *fixed_ : Place{source_, 0, 0, 0}; }

 private:
  std::optional<Place> fixed_;
  std::string text_;
  std::shared_ptr<const SourceText> source_;
};

/// Reports what is not UTF-8, control characters, and tabs that indent. Returns false if there is no use in parsing.
bool check_yaml_text(const YamlSource& source, Diagnostics& diagnostics);

/// Position of the quote that closes the one at the beginning, or npos.
std::size_t closing_quote(std::string_view rest);
/// Length of a text in quotes at the beginning of `rest`; all of it if it goes on below.
std::size_t quoted_length(std::string_view rest);
/// Length of the list or map in brackets at the beginning of `rest`; 1 if it goes on below.
std::size_t bracket_length(std::string_view rest);

/// A message of yaml-cpp 0.7 as a sentence; `line` and `column` (from 0) are where it was thrown.
std::string yaml_problem(const std::string& message, const std::string& line, std::size_t column);

}  // namespace shoal::kernel
