// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads one value against one line of a parameter table.
#include "kernel/case/value_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "kernel/case/overrides.hpp"
#include "kernel/case/scalars.hpp"
#include "kernel/case/sections.hpp"
#include "shoal/shared_fields.hpp"

namespace shoal::kernel {
namespace {

bool is_default(const Place& place) { return place.file().rfind("<default of ", 0) == 0; }

// How many lists deep one value of a kind is written.
int depth_of(std::uint32_t kind) {
  return kind == SHOAL_VECTOR || kind == SHOAL_VECTOR_EXPRESSION ? 1 : kind == SHOAL_MATRIX ? 2 : 0;
}

int depth_of(const Node& node) {
  if (!node.is_sequence()) return 0;
  return 1 + (node.items().empty() ? 0 : depth_of(node.items().front()));
}

std::vector<std::string> shared_names() {
  std::vector<std::string> names;
  for (const SharedField& field : shared_fields) names.emplace_back(field.name);
  return names;
}

class ValueReader {
 public:
  ValueReader(const shoal_parameter& parameter, const SchemaContext& context)
      : parameter_(parameter), context_(context), name_(parameter.key) {
    request_.unit = parameter.unit;
    const std::string text = parameter.default_text != nullptr ? parameter.default_text : "";
    request_.allow_infinite = text.find("inf") != std::string::npos;
  }

  shoal_value read(const Node& node, std::uint32_t origin) {
    const std::size_t before = context_.diagnostics.n_errors();
    std::vector<Node> elements{node};
    if ((parameter_.flags & SHOAL_PARAMETER_LIST) != 0 && node.is_sequence() &&
        (node.items().empty() || depth_of(node) > depth_of(parameter_.kind)))
      elements = node.items();
    if (parameter_.kind == kind_number_map) {
      read_number_map(node, elements);
    } else if (parameter_.kind == kind_field_map) {
      read_field_map(node, elements);
    } else if (!is_read_by_model()) {
      for (const Node& element : elements) read_element(element);
    } else {
      elements.clear();
    }

    shoal_value value{};
    value.size = sizeof(shoal_value);
    value.kind = parameter_.kind;
    value.origin = origin;
    value.place = context_.store.text(node.place().text());
    if (failed_ || context_.diagnostics.n_errors() > before) return value;
    value.n = static_cast<std::uint32_t>(elements.size());
    if (!reals_.empty()) value.reals = context_.store.reals(std::move(reals_));
    if (!integers_.empty()) value.integers = context_.store.integers(std::move(integers_));
    if (!texts_.empty()) value.texts = context_.store.texts(texts_);
    if (!expressions_.empty()) value.expressions = context_.store.expressions(std::move(expressions_));
    if (!objects_.empty()) value.objects = context_.store.objects(std::move(objects_));
    return value;
  }

 private:
  void error(const Place& place, const std::string& message, std::vector<std::string> notes = {}) const {
    context_.diagnostics.error(place, message, std::move(notes));
  }

  // There is no value, and its reason was reported, perhaps elsewhere (a broken parameter, a missing plugin).
  void fail() { failed_ = true; }

  void read_element(const Node& node) {
    switch (parameter_.kind) {
      case SHOAL_BOOLEAN: return boolean(node);
      case SHOAL_INTEGER: return integer(node);
      case SHOAL_REAL: return real(node);
      case SHOAL_VECTOR: return vector(node);
      case SHOAL_MATRIX: return matrix(node);
      case SHOAL_TEXT: return text(node);
      case SHOAL_CHOICE: return choice(node);
      case SHOAL_EXPRESSION: return expression(node);
      case SHOAL_VECTOR_EXPRESSION: return vector_expression(node);
      case SHOAL_BODY: return body(node);
      case SHOAL_FIELD: return field(node);
      case SHOAL_FILE: return file(node);
      case SHOAL_OBJECT: return object(node);
      default:
        error(node.place(),
              "'" + std::string(parameter_.key) + "' is of a kind that this version of Shoal cannot read");
    }
  }

  bool is_read_by_model() const {
    return parameter_.kind == kind_parameters || parameter_.kind == kind_section ||
           parameter_.kind == kind_named_items || parameter_.kind == kind_listed_items;
  }

  // Leaves one element for each entry.
  std::vector<Node::Entry> entries_of(const Node& node, const std::string& what,
                                      std::vector<Node>& elements) const {
    elements.clear();
    std::vector<Node::Entry> entries;
    if (!node.is_map()) {
      std::vector<std::string> notes;
      if (parameter_.example != nullptr)
        notes.push_back(std::string("example: ") + parameter_.key + ": " + parameter_.example);
      error(node.place(), "expected a map of " + what + ", got " + node.described(), notes);
      return entries;
    }
    for (const Node::Entry& entry : node.entries()) {
      if (is_note(entry.key)) continue;
      entries.push_back(entry);
      elements.push_back(entry.value);
    }
    return entries;
  }

  void read_number_map(const Node& node, std::vector<Node>& elements) {
    for (const Node::Entry& entry : entries_of(node, "names and numbers", elements)) {
      texts_.push_back(entry.key);
      name_ = entry.key;
      real(entry.value);
    }
  }

  void read_field_map(const Node& node, std::vector<Node>& elements) {
    for (const Node::Entry& entry : entries_of(node, "fields and their values", elements)) {
      const std::size_t dot = entry.key.find('.');
      if (!is_field_name(entry.key) || dot != std::string::npos) {
        error(entry.key_place,
              dot == std::string::npos
                  ? "'" + entry.key + "' is not the name of a field" + did_you_mean(entry.key, shared_names())
                  : "give all components of '" + entry.key.substr(0, dot) + "' at once, as a list");
        continue;
      }
      const SharedField* shared = find_shared_field(entry.key);
      request_.unit = shared != nullptr ? shared->unit.data() : nullptr;
      const std::vector<Node> items =
          entry.value.is_sequence() ? entry.value.items() : std::vector<Node>{entry.value};
      if (shared != nullptr) check_components(entry, *shared, items.size());
      texts_.push_back(entry.key);
      integers_.push_back(static_cast<std::int64_t>(items.size()));
      for (const Node& item : items) expression(item);
    }
  }

  void check_components(const Node::Entry& entry, const SharedField& field, std::size_t n) const {
    const auto d = static_cast<std::size_t>(context_.dimensions);
    const std::size_t expected = field.rank == SHOAL_SCALAR        ? 1
                                 : field.rank == SHOAL_RANK_VECTOR ? d
                                 : field.rank == SHOAL_SYMMETRIC   ? d * (d + 1) / 2
                                                                   : d * d;
    if (n == expected || d == 0) return;
    const std::string wanted = expected == 1
                                   ? "one number or expression"
                                   : "a list of " + std::to_string(expected) + " numbers or expressions";
    error(entry.value.place(),
          "expected " + wanted + " for the field '" + entry.key + "', got " +
              (entry.value.is_sequence() ? "a list of " + std::to_string(n) : entry.value.described()));
  }

  void boolean(const Node& node) {
    const BooleanText meaning = node.is_scalar() ? parse_boolean(node.text()) : BooleanText::not_boolean;
    const bool is_word = meaning == BooleanText::yes || meaning == BooleanText::no;
    if (is_word && !node.quoted()) {
      integers_.push_back(meaning == BooleanText::yes ? 1 : 0);
    } else if (is_word) {
      error(node.place(), "expected true or false, got a text; leave out the quotes");
    } else if (meaning == BooleanText::other_word) {
      error(node.place(), "expected true or false, got '" + node.text() +
                              "', which YAML readers disagree about; write " +
                              (std::string_view("yYtToO").find(node.text()[0]) != std::string_view::npos &&
                                       node.text() != "off" && node.text() != "Off" && node.text() != "OFF"
                                   ? "true"
                                   : "false"));
    } else {
      error(node.place(), "expected true or false, got " + node.described());
    }
  }

  void integer(const Node& node) {
    if (!node.is_scalar()) return error(node.place(), "expected a whole number, got " + node.described());
    const std::optional<double> value =
        read_number(node, {nullptr, false}, context_.parameters, context_.diagnostics);
    if (!value) return fail();
    if (*value != std::round(*value) || std::fabs(*value) > 9007199254740992.0) {
      const bool literal = parse_number(node.text()).status == NumberText::Status::number;
      return error(node.place(),
                   "expected a whole number, got " +
                       (literal ? node.text() : "'" + node.text() + "' = " + format_number(*value)));
    }
    if (inside_bounds(*value, node)) integers_.push_back(static_cast<std::int64_t>(*value));
  }

  void real(const Node& node) {
    const std::optional<double> value =
        read_number(node, request_, context_.parameters, context_.diagnostics);
    if (!value) return fail();
    if (inside_bounds(*value, node)) reals_.push_back(*value);
  }

  // Items of a list with as many as there are dimensions. Defaults are written for three.
  std::vector<Node> components(const Node& node, const std::string& what) const {
    const std::string expected = "expected " + what;
    if (!node.is_sequence()) {
      error(node.place(), expected + ", got " + node.described());
      return {};
    }
    std::vector<Node> items = node.items();
    // Without (valid) dimensions the case is wrong anyway; nothing is known of lengths then.
    const auto n = context_.dimensions == 0 ? items.size() : static_cast<std::size_t>(context_.dimensions);
    if (is_default(node.place()) && items.size() > n) items.resize(n);
    if (items.size() == n) return items;
    error(node.place(), expected + ", got a list of " + std::to_string(items.size()),
          {"the case has " + std::to_string(n) + " dimensions"});
    return {};
  }

  std::string list_of(const std::string& what) const {
    return "a list of " + (context_.dimensions == 0 ? "2 or 3" : std::to_string(context_.dimensions)) + what;
  }

  void vector(const Node& node) {
    for (const Node& item : components(node, list_of(" numbers"))) real(item);
  }

  void matrix(const Node& node) {
    for (const Node& row : components(node, list_of(" rows"))) {
      for (const Node& item : components(row, "a row of " + std::to_string(context_.dimensions) + " numbers"))
        real(item);
    }
  }

  void text(const Node& node) {
    if (node.is_scalar()) {
      texts_.push_back(node.text());
    } else {
      error(node.place(), "expected a text, got " + node.described());
    }
  }

  void choice(const Node& node) {
    std::vector<std::string> words;
    for (std::uint32_t k = 0; k < parameter_.n_choices; ++k) words.emplace_back(parameter_.choices[k]);
    if (!node.is_scalar())
      return error(node.place(), "expected " + quoted_alternatives(words) + ", got " + node.described());
    const auto found = std::find(words.begin(), words.end(), node.text());
    if (found == words.end())
      return error(node.place(),
                   "'" + node.text() + "' is not one of the choices of '" + parameter_.key + "'" +
                       did_you_mean(node.text(), words),
                   {"choices: " + join(words)});
    integers_.push_back(found - words.begin());
    texts_.push_back(*found);
  }

  void expression(const Node& node) {
    static const std::vector<std::string> plane{"x", "y", "t"};
    static const std::vector<std::string> space{"x", "y", "z", "t"};
    const std::optional<Expression> read =
        read_expression(node, request_, context_.dimensions == 2 ? plane : space, context_.parameters,
                        context_.diagnostics, (parameter_.flags & SHOAL_PARAMETER_NAMES) != 0);
    if (!read) return fail();
    if (!read->is_constant() || inside_bounds(read->value(), node)) expressions_.push_back(*read);
  }

  void vector_expression(const Node& node) {
    for (const Node& item : components(node, list_of(" numbers or expressions"))) expression(item);
  }

  void body(const Node& node) {
    const std::vector<std::string>& names = context_.bodies;
    if (!node.is_scalar()) return error(node.place(), "expected the name of a body, got " + node.described());
    const auto found = std::find(names.begin(), names.end(), node.text());
    if (found == names.end())
      return error(node.place(), "there is no body '" + node.text() + "'" + did_you_mean(node.text(), names),
                   {"bodies: " + join(names)});
    integers_.push_back(found - names.begin());
    texts_.push_back(*found);
  }

  void field(const Node& node) {
    if (!node.is_scalar())
      return error(node.place(), "expected the name of a field, got " + node.described());
    if (!is_field_name(node.text()))
      return error(
          node.place(),
          "'" + node.text() + "' is not the name of a field" + did_you_mean(node.text(), shared_names()),
          {"write a field, e.g. velocity, or a component of it, e.g. velocity.x"});
    texts_.push_back(node.text());
  }

  void file(const Node& node) {
    if (!node.is_scalar() || node.text().empty())
      return error(node.place(), "expected the path of a file, got " + node.described());
    std::filesystem::path path = node.text();
    std::error_code problem;
    // A path of the command line begins where the command was given, like everywhere else.
    if (path.is_relative() && !is_command_line(node.place())) path = context_.folder / path;
    path = std::filesystem::absolute(path, problem).lexically_normal();
    if (!std::filesystem::is_regular_file(path, problem))
      return error(node.place(), "there is no file '" + node.text() + "'", {"looked for " + path.string()});
    texts_.push_back(path.string());
  }

  void object(const Node& node) {
    const shoal_object* read =
        read_typed_object(node, static_cast<shoal_type_kind>(parameter_.object_kind), context_);
    if (read == nullptr) return fail();
    objects_.push_back(read);
  }

  bool inside_bounds(double value, const Node& node) const {
    const std::uint32_t flags = parameter_.flags;
    const bool low_open = (flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED) != 0;
    const bool high_open = (flags & SHOAL_PARAMETER_MAXIMUM_EXCLUDED) != 0;
    const bool too_low = (flags & SHOAL_PARAMETER_HAS_MINIMUM) != 0 &&
                         (low_open ? value <= parameter_.minimum : value < parameter_.minimum);
    const bool too_high = (flags & SHOAL_PARAMETER_HAS_MAXIMUM) != 0 &&
                          (high_open ? value >= parameter_.maximum : value > parameter_.maximum);
    if (!too_low && !too_high) return true;
    const std::string unit = parameter_.unit == nullptr || std::string(parameter_.unit) == "1"
                                 ? ""
                                 : std::string(" ") + parameter_.unit;
    const std::string bound = format_number(too_low ? parameter_.minimum : parameter_.maximum) + unit;
    const std::string relation =
        too_low ? (low_open ? "greater than " : "at least ") : (high_open ? "less than " : "at most ");
    const bool literal = parse_number(node.text()).status == NumberText::Status::number;
    error(node.place(), "'" + name_ + "' must be " + relation + bound + ", got " +
                            (literal ? node.text() : "'" + node.text() + "' = " + format_number(value)));
    return false;
  }

  const shoal_parameter& parameter_;
  const SchemaContext& context_;
  NumberRequest request_;
  bool failed_ = false;
  std::string name_;  // of the value, for messages about bounds
  std::vector<double> reals_;
  std::vector<std::int64_t> integers_;
  std::vector<std::string> texts_;
  std::vector<Expression> expressions_;
  std::vector<const shoal_object*> objects_;
};

class NoTypes : public TypeCatalogue {
 public:
  TypeEntry find(shoal_type_kind, const std::string&) const override { return {}; }
  std::vector<std::string> names(shoal_type_kind) const override { return {}; }
};

}  // namespace

shoal_value read_value(const Node& node, const shoal_parameter& parameter, std::uint32_t origin,
                       const SchemaContext& context) {
  return ValueReader(parameter, context).read(node, origin);
}

std::string check_text_of(const shoal_parameter& parameter, const Node& node) {
  if (parameter.kind == SHOAL_BODY || parameter.kind == SHOAL_FILE || parameter.kind == SHOAL_OBJECT)
    return {};
  const NoTypes types;
  const Parameters parameters;
  std::string first;
  // Examples of vectors may be written for two or for three dimensions.
  for (const int dimensions : {3, 2}) {
    ObjectStore store;
    Diagnostics diagnostics;
    const SchemaContext context{dimensions, parameters, types, {}, {}, store, diagnostics};
    read_value(node, parameter, SHOAL_ORIGIN_DEFAULT, context);
    if (!diagnostics.has_errors()) return {};
    // A name may be a parameter of the case that is to be.
    if (diagnostics.sorted().front().message.rfind("unknown name", 0) == 0) return {};
    if (first.empty()) first = diagnostics.sorted().front().message;
  }
  return first;
}

}  // namespace shoal::kernel
