// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Objects: maps against tables. Single values are read in value_reader.cpp.
#include "kernel/case/schema.hpp"

#include <algorithm>
#include <cctype>
#include <span>

#include "kernel/case/overrides.hpp"
#include "kernel/case/scalars.hpp"
#include "kernel/case/units.hpp"
#include "kernel/case/value_reader.hpp"

namespace shoal::kernel {
namespace {

std::span<const shoal_parameter> parameters_of(const shoal_type& type) {
  return {type.parameters, type.n_parameters};
}

std::vector<std::string> keys_of(const shoal_type& type) {
  std::vector<std::string> keys;
  for (const shoal_parameter& parameter : parameters_of(type)) keys.emplace_back(parameter.key);
  return keys;
}

shoal_value not_set(const shoal_parameter& parameter, const char* place) {
  shoal_value value{};
  value.size = sizeof(shoal_value);
  value.kind = parameter.kind;
  value.place = place;
  return value;
}

// A key that is there under a misspelt name was complained about already.
bool is_misspelt(const Node& map, const char* key, const std::vector<std::string>& known) {
  return std::any_of(map.entries().begin(), map.entries().end(), [&](const Node::Entry& entry) {
    return !is_note(entry.key) && std::find(known.begin(), known.end(), entry.key) == known.end() &&
           closest(entry.key, known) == key;
  });
}

void report_missing(const shoal_parameter& parameter, const shoal_type& type, const Place& place,
                    Diagnostics& diagnostics) {
  std::vector<std::string> notes;
  if (parameter.doc != nullptr) notes.push_back(std::string(parameter.key) + ": " + parameter.doc);
  if (parameter.example != nullptr)
    notes.push_back("example: " + std::string(parameter.key) + ": " + parameter.example);
  diagnostics.error(place, "missing key '" + std::string(parameter.key) + "' in " + type.name, notes);
}

// Values that a table gives by itself: read like the case's own, so that they cannot mean anything else.
shoal_value default_value(const shoal_parameter& parameter, const shoal_type& type,
                          const SchemaContext& context) {
  const Place place{std::make_shared<SourceText>(SourceText{
                        std::string("<default of '") + parameter.key + "' in " + type.name + ">", {}}),
                    0, 0, 0};
  const Node node = read_yaml_value(parameter.default_text, place, context.diagnostics);
  return read_value(node, parameter, SHOAL_ORIGIN_DEFAULT, context);
}

std::string article(const std::string& word) {
  return word == "physics" ? "" : std::string("aeiou").find(word[0]) != std::string::npos ? "an " : "a ";
}

}  // namespace

std::string TypeCatalogue::explain_unknown(shoal_type_kind /*kind*/, const std::string& /*name*/) const {
  return {};
}

bool TypeCatalogue::is_excused(const std::string& /*name*/) const { return false; }

const char* const* ObjectStore::texts(const std::vector<std::string>& v) {
  std::vector<const char*> pointers;
  for (const std::string& item : v) pointers.push_back(text(item));
  return text_lists_.emplace_back(std::move(pointers)).data();
}

const shoal_expression* const* ObjectStore::expressions(std::vector<Expression> v) {
  std::vector<const shoal_expression*> handles;
  for (Expression& expression : v)
    handles.push_back(expressions_.emplace_back(std::move(expression)).handle());
  return expression_lists_.emplace_back(std::move(handles)).data();
}

const shoal_object* ObjectStore::object(const TypeEntry& type, std::vector<shoal_value> values,
                                        const Place& place) {
  Object& stored = objects_.emplace_back(Object{shoal_object{}, std::move(values), type.table});
  stored.object.size = sizeof(shoal_object);
  stored.object.n_values = static_cast<std::uint32_t>(stored.values.size());
  stored.object.type = type.original;
  stored.object.values = stored.values.data();
  stored.object.place = text(place.text());
  return &stored.object;
}

const shoal_type& ObjectStore::table(const shoal_object& object) const {
  const auto found = std::find_if(objects_.begin(), objects_.end(),
                                  [&](const Object& stored) { return &stored.object == &object; });
  return found != objects_.end() ? *found->table : *object.type;
}

bool is_note(const std::string& key) { return key.rfind("x-", 0) == 0; }

bool is_field_name(const std::string& name) {
  const auto is_word = [](std::string_view word) {
    return !word.empty() && std::islower(static_cast<unsigned char>(word[0])) != 0 &&
           std::all_of(word.begin(), word.end(), [](char c) {
             return std::islower(static_cast<unsigned char>(c)) != 0 ||
                    std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_';
           });
  };
  const std::size_t dot = name.find('.');
  return is_word(std::string_view(name).substr(0, dot)) &&
         (dot == std::string::npos || is_word(std::string_view(name).substr(dot + 1)));
}

void report_unknown_keys(const Node& map, const std::vector<std::string>& known, const std::string& owner,
                         Diagnostics& diagnostics) {
  for (const Node::Entry& entry : map.entries()) {
    if (is_note(entry.key) || std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string keys = known.empty() ? "it has no keys" : "keys: " + join(known);
    diagnostics.error(entry.key_place,
                      "unknown key '" + entry.key + "' in " + owner + did_you_mean(entry.key, known),
                      {keys + "      (shoal describe " + owner + ")"});
  }
}

const shoal_object* read_object(const Node& values, const TypeEntry& type, const Place& place,
                                const SchemaContext& context) {
  const shoal_type& table = *type.table;
  const Node map = values.is_map() ? values : Node();
  if (!values.is_map() && !values.is_null()) {
    const std::vector<std::string> keys = keys_of(table);
    context.diagnostics.error(
        values.place(),
        "expected a map of the keys of " + std::string(table.name) + ", got " + values.described(),
        {(keys.empty() ? "it has no keys" : "keys: " + join(keys)) + "      (shoal describe " + table.name +
         ")"});
  } else {
    report_unknown_keys(map, keys_of(table), table.name, context.diagnostics);
  }
  std::vector<shoal_value> result;
  for (const shoal_parameter& parameter : parameters_of(table)) {
    const Node* node = map.find(parameter.key);
    if (node != nullptr) {
      const std::uint32_t origin =
          is_command_line(node->place()) ? SHOAL_ORIGIN_COMMAND_LINE : SHOAL_ORIGIN_CASE;
      result.push_back(read_value(*node, parameter, origin, context));
    } else if (parameter.default_text != nullptr) {
      result.push_back(default_value(parameter, table, context));
    } else {
      if ((parameter.flags & SHOAL_PARAMETER_REQUIRED) != 0 && (values.is_map() || values.is_null()) &&
          !is_misspelt(map, parameter.key, keys_of(table)))
        report_missing(parameter, table, place, context.diagnostics);
      result.push_back(not_set(parameter, context.store.text(place.text())));
    }
  }
  return context.store.object(type, std::move(result), place);
}

const shoal_object* read_named_object(const std::string& name, const Place& name_place, const Node& values,
                                      shoal_type_kind kind, const SchemaContext& context) {
  const TypeEntry type = context.types.find(kind, name);
  if (type) return read_object(values, type, name_place, context);
  if (context.types.is_excused(name)) {
    return nullptr;
  }
  const std::vector<std::string> names = context.types.names(kind);
  std::string explanation = context.types.explain_unknown(kind, name);
  const std::string suggestion = did_you_mean(name, names);
  std::vector<std::string> notes;
  if (!names.empty()) notes.push_back(type_kind_plural(kind) + ": " + join(names));
  std::string message = "unknown " + type_kind_name(kind) + " '" + name + "'";
  if (!explanation.empty()) message += "; " + explanation;
  message += suggestion;
  if (names.empty() && explanation.empty())
    notes.push_back("no plugin that this case lists has " + type_kind_plural(kind));
  context.diagnostics.error(name_place, message, notes);
  return nullptr;
}

const shoal_object* read_typed_object(const Node& node, shoal_type_kind kind, const SchemaContext& context) {
  const std::string name = type_kind_name(kind);
  if (node.is_scalar()) return read_named_object(node.text(), node.place(), Node(), kind, context);
  if (!node.is_map()) {
    context.diagnostics.error(node.place(), "expected " + article(name) + name + ", got " + node.described(),
                              {"write 'type' or '{type: {key: value}}'; " + type_kind_plural(kind) + ": " +
                               join(context.types.names(kind))});
    return nullptr;
  }
  std::vector<const Node::Entry*> entries;
  for (const Node::Entry& entry : node.entries()) {
    if (!is_note(entry.key)) entries.push_back(&entry);
  }
  if (entries.size() == 1)
    return read_named_object(entries[0]->key, entries[0]->key_place, entries[0]->value, kind, context);
  std::vector<std::string> keys;
  for (const Node::Entry* entry : entries) keys.push_back("'" + entry->key + "'");
  const Place place = entries.size() > 1 ? entries[1]->key_place : node.place();
  std::vector<std::string> notes{"write '{type: {key: value}}'; is the line indented enough?"};
  context.diagnostics.error(
      place, "expected one " + name + ", got " + (keys.empty() ? "nothing" : join(keys)), notes);
  return nullptr;
}

std::string check_parameter(const shoal_parameter& parameter) {
  if (parameter.unit != nullptr && std::string(parameter.unit) != "1" && !is_unit(parameter.unit))
    return "UDUNITS-2 does not know its unit '" + std::string(parameter.unit) + "'";
  for (const char* text : {parameter.default_text, parameter.example}) {
    if (text == nullptr) continue;
    Diagnostics diagnostics;
    const Node node = read_yaml_value(text, Place{}, diagnostics);
    const std::string what = text == parameter.default_text ? "default" : "example";
    if (diagnostics.has_errors())
      return "its " + what + " '" + text + "' is not YAML: " + diagnostics.sorted().front().message;
    const std::string problem = check_text_of(parameter, node);
    if (!problem.empty()) return "its " + what + " '" + text + "' is wrong: " + problem;
  }
  return {};
}

std::string type_kind_name(shoal_type_kind kind) {
  switch (kind) {
    case SHOAL_TYPE_OPERATOR: return "operator";
    case SHOAL_TYPE_MATERIAL: return "material";
    case SHOAL_TYPE_PHYSICS: return "physics";
    case SHOAL_TYPE_SHAPE: return "shape";
    case SHOAL_TYPE_OUTPUT: return "output";
    case SHOAL_TYPE_PROBE: return "probe";
  }
  return "section";
}

std::string type_kind_plural(shoal_type_kind kind) {
  return kind == SHOAL_TYPE_PHYSICS ? "physics" : type_kind_name(kind) + "s";
}

const shoal_value* find_value(const shoal_object& object, const shoal_type& table, std::string_view key) {
  for (std::uint32_t k = 0; k < table.n_parameters && k < object.n_values; ++k) {
    if (key == table.parameters[k].key) return &object.values[k];
  }
  return nullptr;
}

}  // namespace shoal::kernel
