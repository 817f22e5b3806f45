// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Tables as JSON Schema (draft 7, which editors' YAML servers read). It is looser than the reader where a text may
// be an expression or carry a unit; the reader has the last word.
#include <nlohmann/json.hpp>

#include "kernel/case/describe.hpp"
#include "kernel/case/scalars.hpp"
#include "kernel/case/sections.hpp"

namespace shoal::kernel {
namespace {

using Json = nlohmann::ordered_json;

Json reference_to(shoal_type_kind kind) { return {{"$ref", "#/definitions/" + type_kind_name(kind)}}; }

Json table_schema(const shoal_type& type);

// A number may be written as one, or as a text with a unit or an expression.
Json number(const shoal_parameter& p) {
  Json value = {{"type", p.kind == SHOAL_INTEGER ? "integer" : "number"}};
  if ((p.flags & SHOAL_PARAMETER_HAS_MINIMUM) != 0)
    value[(p.flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED) != 0 ? "exclusiveMinimum" : "minimum"] = p.minimum;
  if ((p.flags & SHOAL_PARAMETER_HAS_MAXIMUM) != 0)
    value[(p.flags & SHOAL_PARAMETER_MAXIMUM_EXCLUDED) != 0 ? "exclusiveMaximum" : "maximum"] = p.maximum;
  return {{"anyOf", Json::array({value, {{"type", "string"}}})}};
}

Json list_of(const Json& item) { return {{"type", "array"}, {"items", item}}; }

Json map_of(const Json& item) {
  return {
      {"type", "object"}, {"patternProperties", {{"^x-", Json::object()}}}, {"additionalProperties", item}};
}

Json element(const shoal_parameter& p) {
  switch (p.kind) {
    case SHOAL_BOOLEAN: return {{"type", "boolean"}};
    case SHOAL_INTEGER:
    case SHOAL_REAL:
    case SHOAL_EXPRESSION: return number(p);
    case SHOAL_VECTOR:
    case SHOAL_VECTOR_EXPRESSION: return list_of(number(p));
    case SHOAL_MATRIX: return list_of(list_of(number(p)));
    case SHOAL_CHOICE: return {{"enum", std::vector<std::string>(p.choices, p.choices + p.n_choices)}};
    case SHOAL_OBJECT: return reference_to(static_cast<shoal_type_kind>(p.object_kind));
    case SHOAL_TEXT:
    case SHOAL_BODY:
    case SHOAL_FIELD:
    case SHOAL_FILE: return {{"type", Json::array({"string", "number", "boolean"})}};
    case kind_parameters:
    case kind_number_map: return map_of(number(p));
    case kind_field_map: return map_of({{"anyOf", Json::array({number(p), list_of(number(p))})}});
    case kind_section: return table_schema(*section_table(p.key));
    case kind_named_items: return map_of(table_schema(*section_table(p.key)));
    case kind_listed_items: return list_of(table_schema(*section_table(p.key)));
    default: return Json::object();
  }
}

Json value_schema(const shoal_parameter& p) {
  Json schema = element(p);
  if ((p.flags & SHOAL_PARAMETER_LIST) != 0) schema = {{"anyOf", Json::array({schema, list_of(schema)})}};
  std::string doc = p.doc != nullptr ? p.doc : "";
  if (p.unit != nullptr && std::string(p.unit) != "1") doc += std::string(" [") + p.unit + "]";
  // Beside $ref other keys are ignored, so the doc goes around it.
  if (schema.contains("$ref")) schema = {{"allOf", Json::array({schema})}};
  schema["description"] = doc;
  if (p.default_text != nullptr) schema["default"] = p.default_text;
  if (p.example != nullptr) schema["examples"] = Json::array({p.example});
  return schema;
}

Json table_schema(const shoal_type& type) {
  Json properties = Json::object();
  Json required = Json::array();
  for (std::uint32_t k = 0; k < type.n_parameters; ++k) {
    const shoal_parameter& p = type.parameters[k];
    properties[p.key] = value_schema(p);
    if ((p.flags & SHOAL_PARAMETER_REQUIRED) != 0) required.push_back(p.key);
  }
  Json schema = {{"type", "object"},
                 {"description", type.doc != nullptr ? type.doc : ""},
                 {"properties", properties},
                 {"patternProperties", {{"^x-", Json::object()}}},
                 {"additionalProperties", false}};
  // A probe is its common keys and one type.
  if (&type == section_table("probes")) schema["additionalProperties"] = Json::object();
  if (!required.empty()) schema["required"] = required;
  return schema;
}

// The name alone, or a map of the name and its values.
Json choice_of(const std::vector<const shoal_type*>& types, shoal_type_kind kind) {
  Json names = Json::array();
  Json properties = Json::object();
  for (const shoal_type* type : types) {
    const bool stands_for_itself = kind == SHOAL_TYPE_PHYSICS && type->kind == SHOAL_TYPE_OPERATOR;
    if (type->kind != static_cast<std::uint32_t>(kind) && !stands_for_itself) continue;
    names.push_back(type->name);
    properties[type->name] = {{"anyOf", Json::array({table_schema(*type), {{"type", "null"}}})}};
  }
  Json map = {{"type", "object"},
              {"properties", properties},
              {"patternProperties", {{"^x-", Json::object()}}},
              {"additionalProperties", false},
              {"minProperties", 1}};
  return {{"anyOf", Json::array({{{"enum", names}}, map})}};
}

}  // namespace

std::string json_schema(const std::vector<const shoal_type*>& types) {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Shoal case"}};
  schema.update(table_schema(case_table()));
  Json definitions = Json::object();
  for (const shoal_type_kind kind : {SHOAL_TYPE_OPERATOR, SHOAL_TYPE_MATERIAL, SHOAL_TYPE_PHYSICS,
                                     SHOAL_TYPE_SHAPE, SHOAL_TYPE_OUTPUT, SHOAL_TYPE_PROBE})
    definitions[type_kind_name(kind)] = choice_of(types, kind);
  schema["definitions"] = definitions;
  return schema.dump(2) + "\n";
}

}  // namespace shoal::kernel
