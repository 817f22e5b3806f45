// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The types that a case can name: those of the kernel itself and of the plugins that it asked for.
#pragma once

#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/plugins/loader.hpp"
#include "kernel/plugins/table_check.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// A type with its table in the layout of this kernel. Lives as long as the registry.
struct RegisteredType {
  std::string name;
  shoal_type_kind kind;
  std::string plugin;          ///< id; empty for the kernel's own
  std::string plugin_version;  ///< empty for the kernel's own
  /// As its plugin made it: what goes into shoal_object::type, and is read with abi_reading.hpp alone.
  const shoal_type* original;
  /// A copy that can be read as a plain array, also of plugins with shorter or longer structs.
  std::vector<shoal_parameter> parameters;
  shoal_type table;  ///< copy of `original` whose parameters are the above

  const shoal_parameter* parameter(std::string_view key) const;
};

/// Why a name is not known, as far as plugins can tell; misspellings are for the reader, which has `names()`.
struct UnknownType {
  std::vector<shoal_type_kind> other_kinds;  ///< the name exists, as something else
  std::string plugin_to_list;                ///< this plugin is there but the case does not list it
  bool needs_newer_shoal = false;            ///< the plugin has it, for a newer kernel than this
  std::string text;                          ///< one sentence about the above; empty if nothing is known
};

class Registry {
 public:
  explicit Registry(ParameterCheck deeper = {}) : deeper_(std::move(deeper)) {}
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Adds all types of a plugin, or none: throws TableError with everything that is wrong with them.
  void add(const LoadedPlugin& plugin);
  /// The kernel's own types, whose names have no prefix, e.g. the shape `box`.
  void add_own(std::span<const shoal_type* const> types);

  /// Null if there is none.
  const RegisteredType* find(shoal_type_kind kind, std::string_view name) const;
  /// Of all kinds, e.g. for `shoal describe`.
  std::vector<const RegisteredType*> find(std::string_view name) const;
  /// Sorted.
  std::vector<std::string> names(shoal_type_kind kind) const;
  /// In the order of registration.
  const std::deque<RegisteredType>& types() const { return types_; }

  /// `available`: the plugins in the search path, see SearchPath::available().
  UnknownType explain_unknown(shoal_type_kind kind, std::string_view name,
                              const std::vector<std::string>& available) const;

 private:
  struct Source {
    std::string id, version;
    std::filesystem::path path;
    unsigned abi_minor;
  };
  void add(const Source& source, std::span<const shoal_type* const> types);
  void enter(const Source& source, const shoal_type& type);

  ParameterCheck deeper_;
  std::deque<RegisteredType> types_;  // a deque, so that addresses stay
  std::map<std::pair<std::uint32_t, std::string>, const RegisteredType*, std::less<>> by_name_;
  std::vector<std::string> plugins_;
  std::vector<std::string> too_new_;
};

}  // namespace shoal::kernel
