// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where something stands in a text that the user wrote, so that every message can point at it.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace shoal::kernel {

/// A text as it was read: kept for as long as a place points into it, so that messages can quote its lines.
struct SourceText {
  std::string name;                ///< as messages call it: the path as given, or "<--set H=0.5m>"
  std::vector<std::string> lines;  ///< UTF-8, without line ends
};

/// A stretch of characters of one line. Lines and columns count from 1, columns in characters (not bytes).
/// Line 0 means the whole text, as for a setting of the command line.
struct Place {
  std::shared_ptr<const SourceText> source;
  int line = 0;
  int column = 0;
  int length = 0;

  /// The name of the text, or an empty string without one.
  std::string file() const { return source ? source->name : std::string(); }
  /// "dam_break.yaml:12:51", or the name alone for line 0.
  std::string text() const {
    return line == 0 ? file() : file() + ":" + std::to_string(line) + ":" + std::to_string(column);
  }
  /// "dam_break.yaml:12", or the name alone for line 0.
  std::string line_text() const { return line == 0 ? file() : file() + ":" + std::to_string(line); }
  /// `count` characters that begin `offset` characters after the beginning of this place.
  Place part(int offset, int count) const {
    return line == 0 ? *this : Place{source, line, column + offset, count};
  }
};

}  // namespace shoal::kernel
