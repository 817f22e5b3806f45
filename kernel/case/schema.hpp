// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a map of a case against the parameter table of a type. The table is the only description of a parameter:
// this file turns it into checked values, describe.hpp into text and JSON schema, effective.hpp back into YAML.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/expression.hpp"
#include "kernel/case/parameters.hpp"
#include "kernel/case/yaml_reader.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// A type that a case can name. `table` has the layout of this kernel; `original` is what its plugin made and
/// becomes shoal_object::type.
struct TypeEntry {
  const shoal_type* table = nullptr;
  const shoal_type* original = nullptr;
  explicit operator bool() const { return table != nullptr; }
};

/// The types that a case can name: those of the kernel and of the plugins that it lists.
class TypeCatalogue {
 public:
  virtual ~TypeCatalogue() = default;
  /// Empty if there is none.
  virtual TypeEntry find(shoal_type_kind kind, const std::string& name) const = 0;
  /// Sorted.
  virtual std::vector<std::string> names(shoal_type_kind kind) const = 0;
  /// What is known of a name that is not there: a sentence without a full stop such as "it is in the plugin
  /// 'solid'; add it to 'plugins'", or empty.
  virtual std::string explain_unknown(shoal_type_kind kind, const std::string& name) const;
  /// Whether nothing need be said of an unknown name, because its reason was reported already.
  virtual bool is_excused(const std::string& name) const;
};

/// Owns the values of a case, and everything that they point to, at addresses that stay.
class ObjectStore {
 public:
  ObjectStore() = default;
  ObjectStore(const ObjectStore&) = delete;
  ObjectStore& operator=(const ObjectStore&) = delete;

  const char* text(std::string text) { return texts_.emplace_back(std::move(text)).c_str(); }
  const double* reals(std::vector<double> v) { return reals_.emplace_back(std::move(v)).data(); }
  const std::int64_t* integers(std::vector<std::int64_t> v) {
    return integers_.emplace_back(std::move(v)).data();
  }
  const char* const* texts(const std::vector<std::string>& v);
  const shoal_expression* const* expressions(std::vector<Expression> v);
  const shoal_object* const* objects(std::vector<const shoal_object*> v) {
    return object_lists_.emplace_back(std::move(v)).data();
  }
  const shoal_object* object(const TypeEntry& type, std::vector<shoal_value> values, const Place& place);

  /// The table of an object's type in the layout of this kernel.
  const shoal_type& table(const shoal_object& object) const;

 private:
  struct Object {
    shoal_object object;
    std::vector<shoal_value> values;
    const shoal_type* table;
  };
  std::deque<std::string> texts_;
  std::deque<std::vector<double>> reals_;
  std::deque<std::vector<std::int64_t>> integers_;
  std::deque<std::vector<const char*>> text_lists_;
  std::deque<Expression> expressions_;
  std::deque<std::vector<const shoal_expression*>> expression_lists_;
  std::deque<std::vector<const shoal_object*>> object_lists_;
  std::deque<Object> objects_;
};

/// What values are checked against beside their table.
struct SchemaContext {
  int dimensions;
  const Parameters& parameters;
  const TypeCatalogue& types;
  std::vector<std::string> bodies;  ///< names, in order
  std::string folder;               ///< where relative paths of files begin
  ObjectStore& store;
  Diagnostics& diagnostics;
};

/// Reads the values of `type` from a map (null: all defaults). Errors are reported, and the values that they
/// concern are not set. `place` is that of the type's name, for what is missing.
const shoal_object* read_object(const Node& values, const TypeEntry& type, const Place& place,
                                const SchemaContext& context);

/// Reads `type.name` or `{type.name: {key: value}}`. Null if the type is not known (the error is reported).
const shoal_object* read_typed_object(const Node& node, shoal_type_kind kind, const SchemaContext& context);

/// The same for one key and its value, where the map has keys of its own beside it.
const shoal_object* read_named_object(const std::string& name, const Place& name_place, const Node& values,
                                      shoal_type_kind kind, const SchemaContext& context);

/// One value of a table. `origin` is SHOAL_ORIGIN_*.
shoal_value read_value(const Node& node, const shoal_parameter& parameter, std::uint32_t origin,
                       const SchemaContext& context);

/// Reports the keys of a map that are none of `known`; `owner` is "fluid.liquid".
void report_unknown_keys(const Node& map, const std::vector<std::string>& known, const std::string& owner,
                         Diagnostics& diagnostics);

/// Keys that begin with x- are the user's own.
bool is_note(const std::string& key);

/// A field of a body, "velocity", or one of its components, "velocity.x".
bool is_field_name(const std::string& name);

/// What only someone who reads units and expressions can find wrong with a parameter of a plugin's table: its
/// unit, default or example. Empty if all is well.
std::string check_parameter(const shoal_parameter& parameter);

/// "material", "physics", ... and the word for several.
std::string type_kind_name(shoal_type_kind kind);
std::string type_kind_plural(shoal_type_kind kind);

/// The value that the type's table gives the key; null if it has no such key. For the kernel's own tables.
const shoal_value* find_value(const shoal_object& object, const shoal_type& table, std::string_view key);

}  // namespace shoal::kernel
