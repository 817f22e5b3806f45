// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Texts and positions; nothing here knows the tree.
#include "kernel/case/yaml_source.hpp"

#include <algorithm>
#include <sstream>

namespace shoal::kernel {
namespace {

// Length in bytes of the UTF-8 sequence that begins at i, or 0 if it is not valid (RFC 3629).
std::size_t utf8_length(const std::string& s, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < s.size() ? static_cast<unsigned char>(s[k]) : 0U; };
  const auto tail = [&](std::size_t k) { return (byte(k) & 0xC0U) == 0x80U; };
  const unsigned lead = byte(i);
  if (lead < 0x80U) return 1;
  if (lead >= 0xC2U && lead < 0xE0U) return tail(i + 1) ? 2 : 0;
  if ((lead & 0xF0U) == 0xE0U) {
    const bool shortest = lead != 0xE0U || byte(i + 1) >= 0xA0U;
    const bool no_surrogate = lead != 0xEDU || byte(i + 1) < 0xA0U;
    return tail(i + 1) && tail(i + 2) && shortest && no_surrogate ? 3 : 0;
  }
  if (lead >= 0xF0U && lead < 0xF5U) {
    const bool in_range = (lead != 0xF0U || byte(i + 1) >= 0x90U) && (lead != 0xF4U || byte(i + 1) < 0x90U);
    return tail(i + 1) && tail(i + 2) && tail(i + 3) && in_range ? 4 : 0;
  }
  return 0;
}

}  // namespace

YamlSource::YamlSource(std::string text, const std::string& name, std::optional<Place> fixed)
    : fixed_(std::move(fixed)) {
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
  std::string unix_text;
  unix_text.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    unix_text += text[i] == '\r' ? '\n' : text[i];
  }
  text_ = std::move(unix_text);
  auto source = std::make_shared<SourceText>();
  source->name = name;
  std::istringstream stream(text_);
  for (std::string line; std::getline(stream, line);) source->lines.push_back(line);
  if (source->lines.empty()) source->lines.emplace_back();
  source_ = source;
}

Place YamlSource::place(int line, int column, int bytes) const {
  if (fixed_) return *fixed_;
  const int last = static_cast<int>(lines().size()) - 1;
  if (line > last) {
    line = last;
    column = static_cast<int>(lines().back().size());
    bytes = 1;
  }
  const std::string_view content = lines()[static_cast<std::size_t>(line)];
  const auto begin = std::min(static_cast<std::size_t>(std::max(column, 0)), content.size());
  const int length = count_characters(content.substr(begin, static_cast<std::size_t>(std::max(bytes, 0))));
  return {source_, line + 1, count_characters(content.substr(0, begin)) + 1, std::max(length, 1)};
}

bool check_yaml_text(const YamlSource& source, Diagnostics& diagnostics) {
  bool good = true;
  for (std::size_t n = 0; n < source.lines().size(); ++n) {
    const std::string& line = source.lines()[n];
    const int number = static_cast<int>(n);
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t length = utf8_length(line, i);
      const auto c = static_cast<unsigned char>(line[i]);
      if (length == 0) {
        // Not quoted: the line would spoil the user's terminal.
        diagnostics.error(Place{std::make_shared<SourceText>(SourceText{source.whole().file(), {}}),
                                number + 1, static_cast<int>(i) + 1, 1},
                          "this byte is not UTF-8; save the file with the encoding UTF-8");
        return false;
      }
      if ((c < 0x20U && c != '\t') || c == 0x7FU) {
        diagnostics.error(Place{std::make_shared<SourceText>(SourceText{source.whole().file(), {}}),
                                number + 1, static_cast<int>(i) + 1, 1},
                          "a control character stands here; a case is plain text, so remove it");
        return false;
      }
      i += length;
    }
    const std::size_t indent = line.find_first_not_of(" \t");
    const std::size_t tab = line.find('\t');
    if (indent != std::string::npos && tab < indent && line[indent] != '#') {
      diagnostics.error(source.place(number, static_cast<int>(tab), 1),
                        "a tab stands in the indentation; YAML wants spaces (two for each level)");
      good = false;
    }
  }
  return good;
}

std::size_t quoted_length(std::string_view rest) {
  const std::size_t end = closing_quote(rest);
  return end == std::string_view::npos ? rest.size() : end + 1;
}

std::size_t closing_quote(std::string_view rest) {
  const char quote = rest[0];
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (quote == '"' && rest[i] == '\\') {
      ++i;
    } else if (rest[i] == quote) {
      if (quote == '\'' && i + 1 < rest.size() && rest[i + 1] == quote) {
        ++i;
        continue;
      }
      return i;
    }
  }
  return std::string_view::npos;
}

std::size_t bracket_length(std::string_view rest) {
  int depth = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const char c = rest[i];
    const char before = i > 0 ? rest[i - 1] : ' ';
    if ((c == '"' || c == '\'') && (before == ' ' || before == '[' || before == '{' || before == ',')) {
      i += quoted_length(rest.substr(i)) - 1;
    } else if (c == '#' && before == ' ') {
      break;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if ((c == ']' || c == '}') && --depth == 0) {
      return i + 1;
    }
  }
  return 1;
}

std::string yaml_problem(const std::string& message, const std::string& line, std::size_t column) {
  const auto has = [&message](const char* part) { return message.find(part) != std::string::npos; };
  const std::string character =
      column < line.size() ? "'" + line.substr(column, 1) + "'" : "the end of the line";
  if (has("illegal map value")) {
    const std::size_t indent = line.find_first_not_of(" -");
    if (line.substr(0, column).find(": ") != std::string::npos)
      return "a second ': ' stands in this line; put a text that holds ': ' in quotes";
    if (indent != std::string::npos && indent > 0)
      return "this line is indented further than the keys of its map; align it with them";
    return "the text above this line is not 'key: value'";
  }
  if (has("end of map not found"))
    return "this line does not continue the map above it; align its key with the other keys of the map";
  if (has("end of sequence not found"))
    return "this line does not continue the list above it; begin it with '- ' in the same column, or indent "
           "it less";
  if (has("illegal block entry")) return "a list item '- ' cannot begin here; put it on a line of its own";
  if (has("illegal map key")) return "a key cannot begin here; put it on a line of its own";
  if (has("illegal flow end")) return character + " closes nothing; remove it or add the opening bracket";
  if (has("unknown token")) return "a value cannot begin with " + character + "; put it in quotes";
  if (has("illegal EOF in scalar")) return "the text that begins in quotes is never closed";
  if (has("illegal document indicator")) return "the text in quotes is not closed before '---' or '...'";
  if (has("illegal tab")) return "a tab stands in the indentation; YAML wants spaces (two for each level)";
  if (has("unknown escape character"))
    return "unknown escape in double quotes; write \\\\ for a backslash, or use single quotes";
  if (has("invalid unicode") || has("bad character found while scanning hex"))
    return "bad \\x, \\u or \\U escape; it takes 2, 4 or 8 hexadecimal digits";
  if (has("alias not found after") || has("illegal character found while scanning alias"))
    return "'*' begins a YAML alias; put an expression that begins with '*' in quotes";
  if (has("anchor not found after") || has("illegal character found while scanning anchor"))
    return "'&' begins a YAML anchor; put a text that begins with '&' in quotes";
  if (has("multiple anchors") || has("multiple aliases") || has("can't have any content"))
    return "a value has one anchor or is one alias, not both";
  if (has("referenced anchor is not defined"))
    return "no anchor of this name stands above; '*name' repeats a value marked '&name'";
  if (has("tag") || has("TAG"))
    return "YAML tags such as '!' are not used in cases; put a text with '!' in quotes";
  if (has("directive") || has("YAML version"))
    return "YAML directives ('%') are not used in cases; remove the line";
  if (has("block scalar") || has("zero indentation"))
    return "after '|' or '>' the text begins on the next line, indented";
  if (has("bad file")) return "values are nested too deeply";
  return "this is not YAML (" + message + ")";
}

}  // namespace shoal::kernel
