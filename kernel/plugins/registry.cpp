// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Registration of types and their look-up.
#include "kernel/plugins/registry.hpp"

#include <algorithm>

#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

std::string who(const std::string& id) { return id.empty() ? "Shoal itself" : "plugin '" + id + "'"; }

std::string table_error_text(const std::string& plugin, const std::filesystem::path& path,
                             const std::vector<std::string>& problems) {
  std::string text = who(plugin);
  if (!path.empty()) text += " (" + path.string() + ")";
  text += " describes its types wrongly:";
  for (const std::string& problem : problems) text += "\n  " + problem;
  return text;
}

std::string quoted_list(const std::vector<shoal_type_kind>& kinds) {
  std::string text;
  for (const shoal_type_kind kind : kinds) {
    const std::string word = kind_text(kind);
    const bool vowel = word.find_first_of("aeiou") == 0;
    text += (text.empty() ? "" : " and ") +
            std::string(kind == SHOAL_TYPE_PHYSICS ? ""
                        : vowel                    ? "an "
                                                   : "a ") +
            word;
  }
  return text;
}

}  // namespace

TableError::TableError(std::string plugin, const std::filesystem::path& path,
                       std::vector<std::string> problems)
    : std::runtime_error(table_error_text(plugin, path, problems)),
      plugin_(std::move(plugin)),
      problems_(std::move(problems)) {}

const shoal_parameter* RegisteredType::parameter(std::string_view key) const {
  for (const shoal_parameter& candidate : parameters)
    if (key == candidate.key) return &candidate;
  return nullptr;
}

void Registry::add(const LoadedPlugin& plugin) {
  add(Source{plugin.id, plugin.version_text, plugin.path, plugin.stamp.abi_minor}, plugin.types);
  plugins_.push_back(plugin.id);
}

void Registry::add_own(std::span<const shoal_type* const> types) {
  add(Source{{}, {}, {}, SHOAL_ABI_MINOR}, types);
}

void Registry::add(const Source& source, std::span<const shoal_type* const> types) {
  std::vector<std::string> problems;
  std::vector<const shoal_type*> good;
  std::map<std::pair<std::uint32_t, std::string>, int> seen;
  for (const shoal_type* type : types) {
    const bool readable = type->size >= abi_smallest<shoal_type> && type->name;
    // A plugin for a newer kernel may bring kinds that we do not know; the rest of it serves.
    if (readable && source.abi_minor > SHOAL_ABI_MINOR && !is_known(*type)) {
      too_new_.emplace_back(type->name);
      log(LogLevel::warning, std::string("type '") + type->name + "' of " + who(source.id) +
                                 " is for a newer Shoal and is left out");
      continue;
    }
    const auto found = check_type(*type, source.id, deeper_);
    problems.insert(problems.end(), found.begin(), found.end());
    if (!readable) continue;
    const std::pair key(type->kind, std::string(type->name));
    if (seen[key]++ == 1) problems.push_back(key.second + ": the plugin registers it twice");
    if (const auto other = by_name_.find(key); other != by_name_.end())
      problems.push_back(key.second + ": this " + kind_text(type->kind) + " is already registered by " +
                         who(other->second->plugin));
    good.push_back(type);
  }
  if (!problems.empty()) throw TableError(source.id, source.path, std::move(problems));
  for (const shoal_type* type : good) enter(source, *type);
}

void Registry::enter(const Source& source, const shoal_type& type) {
  RegisteredType& entry = types_.emplace_back();
  entry.name = type.name;
  entry.kind = static_cast<shoal_type_kind>(type.kind);
  entry.plugin = source.id;
  entry.plugin_version = source.version;
  entry.original = &type;
  entry.table = abi_copy(&type);
  for (std::uint32_t k = 0; k < type.n_parameters; ++k)
    entry.parameters.push_back(abi_copy(abi_element(type.parameters, k)));
  entry.table.parameters = entry.parameters.empty() ? nullptr : entry.parameters.data();
  by_name_.emplace(std::pair(type.kind, entry.name), &entry);
}

const RegisteredType* Registry::find(shoal_type_kind kind, std::string_view name) const {
  const auto entry = by_name_.find(std::pair<std::uint32_t, std::string>(kind, name));
  return entry == by_name_.end() ? nullptr : entry->second;
}

std::vector<const RegisteredType*> Registry::find(std::string_view name) const {
  std::vector<const RegisteredType*> found;
  for (const RegisteredType& type : types_)
    if (type.name == name) found.push_back(&type);
  return found;
}

std::vector<std::string> Registry::names(shoal_type_kind kind) const {
  std::vector<std::string> list;
  for (const auto& [key, type] : by_name_)
    if (key.first == static_cast<std::uint32_t>(kind)) list.push_back(key.second);
  return list;
}

UnknownType Registry::explain_unknown(shoal_type_kind kind, std::string_view name,
                                      const std::vector<std::string>& available) const {
  UnknownType answer;
  for (const RegisteredType* type : find(name))
    if (type->kind != kind) answer.other_kinds.push_back(type->kind);
  const std::string prefix(name.substr(0, name.find('.')));
  const auto contains = [&](const std::vector<std::string>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (!answer.other_kinds.empty()) {
    answer.text =
        "'" + std::string(name) + "' is " + quoted_list(answer.other_kinds) + ", not " + quoted_list({kind});
  } else if (contains(too_new_, name)) {
    answer.needs_newer_shoal = true;
    answer.text = "'" + std::string(name) + "' of plugin '" + prefix + "' is for a newer Shoal than this one";
  } else if (!contains(plugins_, prefix) && contains(available, prefix)) {
    answer.plugin_to_list = prefix;
    answer.text = "types of this name come from plugin '" + prefix +
                  "', which is there but not listed under 'plugins:'";
  } else if (!contains(plugins_, prefix) && name.find('.') != std::string_view::npos) {
    answer.text = "there is no plugin '" + prefix + "' that could provide it";
  }
  return answer;
}

}  // namespace shoal::kernel
