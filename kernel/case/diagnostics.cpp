// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects and formats what is wrong with a case.
#include "kernel/case/diagnostics.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <tuple>

namespace shoal::kernel {
namespace {

constexpr int tab_width = 4;
constexpr int widest_line = 100;  // longer source lines are shown in part, around the caret

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

// The code point that begins at `i`; moves `i` behind it. The text is valid UTF-8 (the reader checked it).
std::uint32_t next_code_point(std::string_view s, std::size_t& i) {
  const auto lead = static_cast<unsigned char>(s[i++]);
  std::uint32_t value = lead < 0x80U   ? lead
                        : lead < 0xE0U ? lead & 0x1FU
                        : lead < 0xF0U ? lead & 0x0FU
                                       : lead & 0x07U;
  while (i < s.size() && is_continuation(s[i]))
    value = (value << 6U) | (static_cast<unsigned char>(s[i++]) & 0x3FU);
  return value;
}

// Columns of a terminal: combining marks take none, East Asian wide characters and emoji two (Unicode annex 11).
int width_of(std::uint32_t c) {
  const auto in = [c](std::uint32_t first, std::uint32_t last) { return c >= first && c <= last; };
  if (in(0x0300, 0x036F) || in(0x200B, 0x200F) || in(0x20D0, 0x20FF) || in(0xFE00, 0xFE0F) || c == 0xFEFF)
    return 0;
  if (in(0x1100, 0x115F) || in(0x2E80, 0x303E) || in(0x3041, 0xA4CF) || in(0xAC00, 0xD7A3) ||
      in(0xF900, 0xFAFF) || in(0xFE30, 0xFE6F) || in(0xFF00, 0xFF60) || in(0xFFE0, 0xFFE6) ||
      in(0x1F300, 0x1F64F) || in(0x1F900, 0x1F9FF) || in(0x20000, 0x3FFFD))
    return 2;
  return 1;
}

std::string lower_case(std::string_view s) {
  std::string out(s);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// A source line as shown: tabs expanded, cut to a window around the marked part, with the marked columns.
struct ShownLine {
  std::string text;
  int begin = 0;
  int width = 0;
};

ShownLine show(const std::string& line, int column, int length) {
  std::vector<std::pair<std::string, int>> cells;  // one per character: text and width
  int begin = -1;
  int end = -1;
  int at = 0;
  int character = 1;
  for (std::size_t i = 0; i < line.size(); ++character) {
    const std::size_t first = i;
    const std::uint32_t c = next_code_point(line, i);
    if (character == column) begin = at;
    if (c == '\t') {
      const int spaces = tab_width - at % tab_width;
      cells.emplace_back(std::string(static_cast<std::size_t>(spaces), ' '), spaces);
    } else {
      cells.emplace_back(line.substr(first, i - first), width_of(c));
    }
    at += cells.back().second;
    if (character == column + length - 1) end = at;
  }
  if (begin < 0) begin = at + std::max(0, column - character);
  if (end < begin) end = std::max(at, begin + 1);

  ShownLine shown;
  const bool cut = at > widest_line;
  const int left = cut && begin > widest_line - 20 ? std::min(begin - 20, at - widest_line) : 0;
  const int right = cut ? left + widest_line : at;
  int position = 0;
  if (left > 0) shown.text = "...";
  const int shift = left > 0 ? 3 - left : 0;
  for (const auto& [text, width] : cells) {
    if (position >= left && position + width <= right) shown.text += text;
    position += width;
  }
  if (right < at) shown.text += "...";
  shown.begin = begin + shift;
  shown.width = std::max(1, std::min(end, std::max(right, begin + 1)) - begin);
  while (!shown.text.empty() && shown.text.back() == ' ') shown.text.pop_back();
  return shown;
}

// Long lists of keys go on below, indented further.
std::string wrapped_note(const std::string& note) {
  constexpr std::size_t width = 104;
  std::string text;
  std::string indent = "      ";
  std::size_t begin = 0;
  while (begin < note.size()) {
    std::size_t end = note.size();
    if (indent.size() + end - begin > width) {
      const std::size_t space = note.rfind(' ', begin + width - indent.size());
      if (space != std::string::npos && space > begin) end = space;
    }
    std::size_t last = end;
    while (last > begin && note[last - 1] == ' ') --last;
    text += indent + note.substr(begin, last - begin) + "\n";
    begin = note.find_first_not_of(' ', end);
    if (begin == std::string::npos) break;
    indent = "            ";
  }
  return text;
}

std::string plural(std::size_t n, const std::string& word) {
  return std::to_string(n) + " more " + word + (n == 1 ? "" : "s");
}

}  // namespace

void Diagnostics::add(Diagnostic item) {
  // A value that is used twice through an alias would be complained about twice.
  for (const Diagnostic& other : items_) {
    if (other.place.line == item.place.line && other.place.column == item.place.column &&
        other.place.source == item.place.source && other.message == item.message)
      return;
  }
  if (item.severity == Severity::error) ++n_errors_;
  items_.push_back(std::move(item));
}

void Diagnostics::error(const Place& place, std::string message, std::vector<std::string> notes) {
  add({Severity::error, place, std::move(message), std::move(notes)});
}

void Diagnostics::warning(const Place& place, std::string message, std::vector<std::string> notes) {
  add({Severity::warning, place, std::move(message), std::move(notes)});
}

void Diagnostics::append(const Diagnostics& other) {
  for (const Diagnostic& item : other.items_) add(item);
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<const SourceText*> sources;
  const auto order = [&sources](const Diagnostic& item) {
    const auto found = std::find(sources.begin(), sources.end(), item.place.source.get());
    return std::make_tuple(found - sources.begin(), item.place.line, item.place.column);
  };
  for (const Diagnostic& item : items_) {
    if (std::find(sources.begin(), sources.end(), item.place.source.get()) == sources.end())
      sources.push_back(item.place.source.get());
  }
  std::vector<Diagnostic> result = items_;
  std::stable_sort(result.begin(), result.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return order(a) < order(b); });
  return result;
}

std::string Diagnostics::format(std::size_t limit) const {
  const std::size_t errors = std::min(n_errors_, limit);
  const std::size_t warnings = std::min(n_warnings(), limit - errors);
  std::size_t error_count = 0;
  std::size_t warning_count = 0;
  std::string text;
  for (const Diagnostic& item : sorted()) {
    const bool is_error = item.severity == Severity::error;
    if ((is_error ? error_count++ : warning_count++) < (is_error ? errors : warnings))
      text += kernel::format(item);
  }
  const std::size_t more_errors = n_errors_ - errors;
  const std::size_t more_warnings = n_warnings() - warnings;
  if (more_errors + more_warnings > 0) {
    text += "... and ";
    if (more_errors > 0) text += plural(more_errors, "error");
    if (more_errors > 0 && more_warnings > 0) text += " and ";
    if (more_warnings > 0) text += plural(more_warnings, "warning");
    text += "\n";
  }
  return text;
}

void Diagnostics::throw_if_errors() const {
  if (has_errors()) throw UserError(*this);
}

std::string format(const Diagnostic& item) {
  std::string text = item.place.text();
  if (!text.empty()) text += ": ";
  text += item.severity == Severity::error ? "error: " : "warning: ";
  text += item.message + "\n";
  const Place& place = item.place;
  if (place.source && place.line >= 1 && static_cast<std::size_t>(place.line) <= place.source->lines.size()) {
    const ShownLine shown =
        show(place.source->lines[static_cast<std::size_t>(place.line) - 1], place.column, place.length);
    std::string number = std::to_string(place.line);
    number.insert(0, number.size() < 5 ? 5 - number.size() : 0, ' ');
    text += number + " | " + shown.text + "\n";
    text += std::string(number.size(), ' ') + " | " +
            std::string(static_cast<std::size_t>(shown.begin), ' ') + "^" +
            std::string(static_cast<std::size_t>(shown.width) - 1, '~') + "\n";
  }
  for (const std::string& note : item.notes) text += wrapped_note(note);
  return text;
}

UserError::UserError(Diagnostics diagnostics)
    : std::runtime_error(diagnostics.format()), diagnostics_(std::move(diagnostics)) {}

UserError::UserError(const Place& place, const std::string& message, std::vector<std::string> notes)
    : UserError([&] {
        Diagnostics diagnostics;
        diagnostics.error(place, message, std::move(notes));
        return diagnostics;
      }()) {}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size() + 1;
  std::vector<std::size_t> before(n);
  std::vector<std::size_t> previous(n);
  std::vector<std::size_t> current(n);
  for (std::size_t j = 0; j < n; ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j < n; ++j) {
      const std::size_t change = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

std::string closest(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string wanted = lower_case(word);
  const std::size_t allowed = std::min<std::size_t>(2, (wanted.size() + 2) / 3);
  std::string best;
  std::size_t best_distance = allowed + 1;
  for (const std::string& candidate : candidates) {
    if (candidate == word) continue;
    const std::string lowered = lower_case(candidate);
    const std::size_t dot = lowered.rfind('.');
    std::size_t distance = edit_distance(wanted, lowered);
    if (dot != std::string::npos && lowered.substr(dot + 1) == wanted) distance = 0;
    // Two edits of four letters, or one of a single letter, leave nothing in common: "foo" is not "n".
    if (2 * distance > wanted.size() || distance >= lowered.size()) continue;
    if (distance == 2 && wanted.size() < 5) continue;
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty() || wanted.size() < 3) return best;
  int matches = 0;
  for (const std::string& candidate : candidates) {
    if (lower_case(candidate).rfind(wanted, 0) == 0) {
      ++matches;
      best = candidate;
    }
  }
  return matches == 1 ? best : std::string();
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string best = closest(word, candidates);
  return best.empty() ? best : "; did you mean '" + best + "'?";
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += separator;
    text += words[i];
  }
  return text;
}

std::string quoted_alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += "'" + words[i] + "'";
  }
  return text;
}

int display_width(std::string_view utf8) {
  int width = 0;
  for (std::size_t i = 0; i < utf8.size();) width += width_of(next_code_point(utf8, i));
  return width;
}

int count_characters(std::string_view utf8) {
  return static_cast<int>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return !is_continuation(c); }));
}

}  // namespace shoal::kernel
