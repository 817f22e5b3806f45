// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Tables as text.
#include "kernel/case/describe.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <sstream>

#include "kernel/case/scalars.hpp"
#include "kernel/case/sections.hpp"

namespace shoal::kernel {
namespace {

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  std::string line;
  for (std::string word; stream >> word;) {
    if (!line.empty() && static_cast<std::size_t>(display_width(line + " " + word)) > width) {
      lines.push_back(line);
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty() || lines.empty()) lines.push_back(line);
  return lines;
}

std::string kind_of_value(const shoal_parameter& p) {
  const std::string unit = p.unit != nullptr && std::string(p.unit) != "1" ? p.unit : "";
  const auto with_unit = [&unit](const std::string& word) {
    return unit.empty() ? word : word + ", " + unit;
  };
  switch (p.kind) {
    case SHOAL_BOOLEAN: return "true or false";
    case SHOAL_INTEGER: return "whole number";
    case SHOAL_REAL: return with_unit("number");
    case SHOAL_VECTOR: return with_unit("vector");
    case SHOAL_MATRIX: return with_unit("matrix");
    case SHOAL_TEXT: return "text";
    case SHOAL_CHOICE: return "word";
    case SHOAL_EXPRESSION: return with_unit("expression");
    case SHOAL_VECTOR_EXPRESSION: return with_unit("vector of expressions");
    case SHOAL_BODY: return "body";
    case SHOAL_FIELD: return "field";
    case SHOAL_FILE: return "file";
    case SHOAL_OBJECT: return type_kind_name(static_cast<shoal_type_kind>(p.object_kind));
    case kind_number_map: return with_unit("map of numbers");
    case kind_field_map: return "map of fields";
    case kind_named_items: return "map of names";
    case kind_listed_items: return "list of maps";
    default: return "map";
  }
}

std::string default_of(const shoal_parameter& p) {
  if ((p.flags & SHOAL_PARAMETER_REQUIRED) != 0) return "required";
  return p.default_text != nullptr ? p.default_text : "not set";
}

std::string bounds_of(const shoal_parameter& p) {
  const bool low = (p.flags & SHOAL_PARAMETER_HAS_MINIMUM) != 0;
  const bool high = (p.flags & SHOAL_PARAMETER_HAS_MAXIMUM) != 0;
  std::vector<std::string> parts;
  const std::string unit = p.unit != nullptr && std::string(p.unit) != "1" ? " " + std::string(p.unit) : "";
  if (low)
    parts.push_back(((p.flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED) != 0 ? "greater than " : "at least ") +
                    format_number(p.minimum) + unit);
  if (high)
    parts.push_back(((p.flags & SHOAL_PARAMETER_MAXIMUM_EXCLUDED) != 0 ? "less than " : "at most ") +
                    format_number(p.maximum) + unit);
  return join(parts, ", ");
}

std::string explanation(const shoal_parameter& p) {
  std::string text = p.doc != nullptr ? p.doc : "";
  const auto sentence = [&text](const std::string& words) {
    if (!words.empty()) text += (text.empty() ? "" : " ") + words + ".";
  };
  if (p.n_choices > 0) {
    std::vector<std::string> words(p.choices, p.choices + p.n_choices);
    sentence("One of " + join(words));
  }
  if (const std::string bounds = bounds_of(p); !bounds.empty()) sentence("Must be " + bounds);
  return text;
}

std::string padded(const std::string& text, std::size_t width) {
  const auto have = static_cast<std::size_t>(display_width(text));
  return text + std::string(have < width ? width - have : 0, ' ');
}

}  // namespace

std::string describe_type(const shoal_type& type, const std::string& owner, int width) {
  const auto columns = static_cast<std::size_t>(std::max(width, 60));
  const std::span<const shoal_parameter> parameters(type.parameters, type.n_parameters);
  std::string text = std::string(type.name) + "  (" +
                     (owner.empty() ? type_kind_name(static_cast<shoal_type_kind>(type.kind)) : owner) +
                     ")\n";
  for (const std::string& line : wrapped(type.doc != nullptr ? type.doc : "", columns)) text += line + "\n";
  if (type.source != nullptr) {
    for (const std::string& line : wrapped("Source: " + std::string(type.source), columns))
      text += line + "\n";
  }
  if (parameters.empty()) return text + "\n  It has no keys.\n";

  std::array<std::size_t, 3> widths{3, 5, 7};
  for (const shoal_parameter& p : parameters) {
    const std::string list = (p.flags & SHOAL_PARAMETER_LIST) != 0 ? "list of: " : "";
    widths[0] = std::max(widths[0], std::string(p.key).size());
    widths[1] = std::max(widths[1], (list + kind_of_value(p)).size());
    widths[2] = std::max(widths[2], default_of(p).size());
  }
  widths[2] = std::min<std::size_t>(widths[2], 24);
  const std::size_t before = 2 + widths[0] + 2 + widths[1] + 2 + widths[2] + 2;
  const std::size_t room = columns > before + 24 ? columns - before : 24;
  text += "\n  " + padded("key", widths[0]) + "  " + padded("value", widths[1]) + "  " +
          padded("default", widths[2]) + "  meaning\n";
  for (const shoal_parameter& p : parameters) {
    const std::string list = (p.flags & SHOAL_PARAMETER_LIST) != 0 ? "list of: " : "";
    std::string line = "  " + padded(p.key, widths[0]) + "  " + padded(list + kind_of_value(p), widths[1]) +
                       "  " + padded(default_of(p), widths[2]) + "  ";
    std::vector<std::string> parts = wrapped(explanation(p), room);
    if (p.example != nullptr) {
      // On a line of its own and without a full stop, since it is there to be copied.
      for (std::string& part : wrapped("Example: " + std::string(p.key) + ": " + p.example, room))
        parts.push_back(std::move(part));
    }
    for (const std::string& part : parts) {
      line += part;
      while (!line.empty() && line.back() == ' ') line.pop_back();
      text += line + "\n";
      line = std::string(before, ' ');
    }
  }
  return text;
}

}  // namespace shoal::kernel
