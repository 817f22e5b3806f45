// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a model back as YAML, driven by the tables that it was read with.
#include "kernel/case/effective.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "kernel/case/scalars.hpp"
#include "kernel/case/sections.hpp"

namespace shoal::kernel {
namespace {

constexpr std::size_t comment_column = 44;

class Writer {
 public:
  explicit Writer(const CaseModel& model) : model_(model) {}

  std::string write() {
    text_ = "# The case " + model_.name +
            " as it was computed: all values, in SI units, and where each came from.\n";
    const shoal_type& table = case_table();
    for (std::uint32_t k = 0; k < table.n_parameters; ++k)
      top_level(table.parameters[k], model_.values->values[k]);
    return std::move(text_);
  }

 private:
  void line(int indent, const std::string& content, const std::string& comment = {}) {
    std::string full(static_cast<std::size_t>(indent) * 2, ' ');
    full += content;
    if (!comment.empty()) {
      const auto width = static_cast<std::size_t>(display_width(full));
      full += std::string(width < comment_column ? comment_column - width : 1, ' ') + "# " + comment;
    }
    text_ += full + "\n";
  }

  // "m, dam_break.yaml:12"
  static std::string origin(const shoal_value& value, const char* unit) {
    std::string place = value.place != nullptr ? value.place : "";
    if (value.origin == SHOAL_ORIGIN_DEFAULT) place = "default";
    if (value.origin == SHOAL_ORIGIN_COMMAND_LINE) place = "--set";
    if (value.origin == SHOAL_ORIGIN_CASE) place = place.substr(0, place.rfind(':'));  // without the column
    const bool has_unit = unit != nullptr && std::string_view(unit) != "1";
    return (has_unit ? std::string(unit) + ", " : std::string()) + place;
  }

  void top_level(const shoal_parameter& parameter, const shoal_value& value) {
    const std::string_view key = parameter.key;
    if (parameter.kind == kind_parameters) return parameters();
    if (key == "smoothing") return section(key, model_.smoothing);
    if (key == "domain") return section(key, model_.domain.values);
    if (key == "run") return section(key, model_.run.values);
    if (key == "bodies") return bodies();
    if (key == "probes") return probes();
    if (key == "reference") return references();
    entry(parameter, value, 0);
  }

  void parameters() {
    if (model_.parameters.all().empty()) return;
    line(0, "parameters:");
    for (const Parameters::Parameter& parameter : model_.parameters.all()) {
      std::string value = format_number(parameter.value);
      // The unit goes along: a parameter alone, "$dx", is checked for it.
      if (!parameter.unit.empty() && parameter.unit != "1") value += " " + parameter.unit;
      std::string comment = parameter.place.line == 0 ? "--set" : parameter.place.line_text();
      if (parameter.text != value) comment += ": " + parameter.text;
      line(1, parameter.name + ": " + value, comment);
    }
  }

  void section(std::string_view key, const shoal_object* values) {
    line(0, std::string(key) + ":");
    object_values(*values, 1);
  }

  void bodies() {
    line(0, "bodies:");
    for (const BodyModel& body : model_.bodies) {
      line(1, body.name + ":", origin_of(body.place));
      object_values(*body.values, 2);
    }
  }

  void probes() {
    if (model_.probes.empty()) return;
    line(0, "probes:");
    for (const ProbeModel& probe : model_.probes) {
      line(1, probe.name + ":", origin_of(probe.place));
      object(*probe.object, 2, "");
      object_values(*probe.values, 2);
    }
  }

  void references() {
    if (model_.references.empty()) return;
    line(0, "reference:");
    for (const ReferenceModel& reference : model_.references) {
      line(1, "-", origin_of(reference.place));
      object_values(*reference.values, 2);
    }
  }

  static std::string origin_of(const std::string& place) {
    return place.rfind("<--", 0) == 0 ? "--set" : place.substr(0, place.rfind(':'));
  }

  // `type:` and its values below, or `type: {}`; `lead` is "- " in a list.
  void object(const shoal_object& object, int indent, const std::string& lead) {
    const shoal_type& table = model_.store.table(object);
    const std::string name = std::string(table.name) + ":";
    bool any = false;
    for (std::uint32_t k = 0; k < table.n_parameters; ++k)
      any = any || object.values[k].n > 0 || is_empty_list(table.parameters[k], object.values[k]);
    line(indent, lead + name + (any ? "" : " {}"), origin_of(object.place));
    object_values(object, indent + (lead.empty() ? 1 : 2));
  }

  void object_values(const shoal_object& object, int indent) {
    const shoal_type& table = model_.store.table(object);
    for (std::uint32_t k = 0; k < table.n_parameters; ++k)
      entry(table.parameters[k], object.values[k], indent);
  }

  // An empty list that the case or the table gives is a value too.
  static bool is_empty_list(const shoal_parameter& parameter, const shoal_value& value) {
    return value.n == 0 && (parameter.flags & SHOAL_PARAMETER_LIST) != 0 &&
           (parameter.default_text != nullptr || value.origin != SHOAL_ORIGIN_DEFAULT);
  }

  void entry(const shoal_parameter& parameter, const shoal_value& value, int indent) {
    const std::string key = std::string(parameter.key) + ":";
    const bool is_list = (parameter.flags & SHOAL_PARAMETER_LIST) != 0;
    if (value.n == 0) {
      if (is_empty_list(parameter, value)) {
        line(indent, key + " []", origin(value, nullptr));
      } else {
        line(indent, "# " + key + " not set");
      }
    } else if (parameter.kind == SHOAL_OBJECT) {
      line(indent, key);
      for (std::uint32_t k = 0; k < value.n; ++k) object(*value.objects[k], indent + 1, is_list ? "- " : "");
    } else if (parameter.kind == kind_number_map || parameter.kind == kind_field_map) {
      line(indent, key, origin(value, nullptr));
      map(parameter, value, indent + 1);
    } else {
      line(indent, key + " " + content(parameter, value, is_list), origin(value, parameter.unit));
    }
  }

  void map(const shoal_parameter& parameter, const shoal_value& value, int indent) {
    std::uint32_t next = 0;
    for (std::uint32_t k = 0; k < value.n; ++k) {
      const std::string key = yaml_text(value.texts[k]) + ": ";
      if (parameter.kind == kind_number_map) {
        line(indent, key + format_number(value.reals[k]));
        continue;
      }
      std::vector<std::string> items;
      for (std::int64_t c = 0; c < value.integers[k]; ++c)
        items.push_back(expression(value.expressions[next++]));
      line(indent, key + (items.size() == 1 ? items[0] : "[" + join(items) + "]"));
    }
  }

  std::string content(const shoal_parameter& parameter, const shoal_value& value, bool is_list) const {
    std::vector<std::string> elements;
    for (std::uint32_t k = 0; k < value.n; ++k) elements.push_back(element(parameter, value, k));
    return is_list ? "[" + join(elements) + "]" : elements[0];
  }

  std::string element(const shoal_parameter& parameter, const shoal_value& value, std::uint32_t k) const {
    const auto d = static_cast<std::uint32_t>(model_.dimensions);
    std::vector<std::string> parts;
    switch (parameter.kind) {
      case SHOAL_BOOLEAN: return value.integers[k] != 0 ? "true" : "false";
      case SHOAL_INTEGER: return std::to_string(value.integers[k]);
      case SHOAL_REAL: return format_number(value.reals[k]);
      case SHOAL_VECTOR: return numbers(value.reals + k * d, d);
      case SHOAL_MATRIX:
        for (std::uint32_t row = 0; row < d; ++row)
          parts.push_back(numbers(value.reals + (k * d + row) * d, d));
        return "[" + join(parts) + "]";
      case SHOAL_EXPRESSION: return expression(value.expressions[k]);
      case SHOAL_VECTOR_EXPRESSION:
        for (std::uint32_t c = 0; c < d; ++c) parts.push_back(expression(value.expressions[k * d + c]));
        return "[" + join(parts) + "]";
      default: return yaml_text(value.texts[k]);
    }
  }

  static std::string numbers(const double* values, std::uint32_t n) {
    std::vector<std::string> parts;
    for (std::uint32_t c = 0; c < n; ++c) parts.push_back(format_number(values[c]));
    return "[" + join(parts) + "]";
  }

  static std::string expression(const shoal_expression* handle) {
    const Expression& expression = Expression::from_handle(handle);
    return expression.is_constant() ? format_number(expression.value()) : yaml_text(expression.text());
  }

  const CaseModel& model_;
  std::string text_;
};

}  // namespace

std::string yaml_text(const std::string& text) {
  const auto plain_begin = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
  };
  const auto plain_part = [&](char c) {
    return plain_begin(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ||
           c == '+';
  };
  const bool is_word =
      !text.empty() && plain_begin(text[0]) && std::all_of(text.begin(), text.end(), plain_part);
  const bool has_meaning =
      parse_boolean(text) != BooleanText::not_boolean || text == "null" || text == "Null" || text == "NULL";
  if (is_word && !has_meaning) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string effective_case(const CaseModel& model) { return Writer(model).write(); }

}  // namespace shoal::kernel
