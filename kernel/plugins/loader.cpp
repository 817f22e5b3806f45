// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requirements between plugins are known only when a plugin has described itself, so loading is a depth-first
// walk; the order in which plugins are completed is the topological order.
#include "kernel/plugins/loader.hpp"

#include <algorithm>

#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

void check_version(const LoadedPlugin& plugin, const VersionRange& versions, const std::string& who) {
  const std::string wanted = unmet(versions, plugin.version);
  if (wanted.empty()) return;
  throw LoadFailure(LoadProblem::version, plugin.id, plugin.path,
                    "plugin '" + plugin.id + "' (" + plugin.path.string() + ") has version " +
                        plugin.version_text + ", but " + who + " needs " + wanted);
}

}  // namespace

const LoadedPlugin& Loader::load(const std::string& id, const VersionRange& versions) {
  std::vector<std::string> chain;
  const LoadedPlugin& plugin = load(id, chain);
  check_version(plugin, versions, "the case");
  return plugin;
}

bool Loader::is_loaded(std::string_view id) const {
  return std::any_of(loaded_.begin(), loaded_.end(),
                     [&](const LoadedPlugin* plugin) { return plugin->id == id; });
}

const LoadedPlugin& Loader::load(const std::string& id, std::vector<std::string>& chain) {
  for (const LoadedPlugin* plugin : loaded_)
    if (plugin->id == id) return *plugin;
  if (const auto failure = failures_.find(id); failure != failures_.end()) throw LoadFailure(failure->second);
  if (const auto first = std::find(chain.begin(), chain.end(), id); first != chain.end()) {
    std::vector<std::string> cycle(first, chain.end());
    cycle.push_back(id);
    throw LoadFailure(LoadProblem::cycle, id, {},
                      "plugins require one another in a circle: " + joined(cycle, " -> "));
  }
  chain.push_back(id);
  try {
    const LoadedPlugin& plugin = load_new(id, chain);
    chain.pop_back();
    return plugin;
  } catch (const LoadFailure& failure) {
    chain.pop_back();
    failures_.emplace(id, failure);
    throw;
  }
}

const LoadedPlugin& Loader::load_new(const std::string& id, std::vector<std::string>& chain) {
  if (!is_snake_case(id))
    throw LoadFailure(
        LoadProblem::bad_id, id, {}, "'" + id + "' cannot be the name of a plugin",
        {"a plugin is asked for by its id, a word such as vtk; folders to search are named with "
         "--plugin-path or SHOAL_PLUGIN_PATH"});
  const auto path = search_path_.find(id);
  if (!path) throw not_found(id);
  log(LogLevel::debug, "plugin '" + id + "': " + path->string());
  const LoadedPlugin& plugin = open_plugin_file(*path, id);
  load_requirements(plugin, chain);
  loaded_.push_back(&plugin);
  log(LogLevel::debug, "plugin '" + id + "': version " + plugin.version_text + ", " +
                           std::to_string(plugin.types.size()) + " types");
  return plugin;
}

void Loader::load_requirements(const LoadedPlugin& plugin, std::vector<std::string>& chain) {
  for (const Requirement& requirement : plugin.requirements) {
    const LoadedPlugin* other = nullptr;
    try {
      other = &load(requirement.id, chain);
    } catch (const LoadFailure& failure) {
      if (failure.problem() == LoadProblem::cycle) throw;
      LoadFailure with_reason(LoadProblem::requirement, plugin.id, plugin.path,
                              "plugin '" + plugin.id + "' (" + plugin.path.string() + ") requires plugin '" +
                                  requirement.id + "', which cannot be loaded: " + failure.what(),
                              failure.notes());
      with_reason.set_available(failure.available());
      throw with_reason;
    }
    check_version(*other, requirement.versions, "plugin '" + plugin.id + "'");
  }
}

LoadFailure Loader::not_found(const std::string& id) const {
  std::vector<std::string> notes;
  for (const std::string& line : search_path_.description()) notes.push_back("searched: " + line);
  if (notes.empty()) notes.emplace_back("no folder was searched");
  const std::vector<std::string> available = search_path_.available();
  notes.push_back(available.empty() ? "there are no plugins in these folders"
                                    : "plugins there: " + joined(available, ", "));
  LoadFailure failure(LoadProblem::not_found, id, {}, "there is no plugin '" + id + "'", std::move(notes));
  failure.set_available(available);
  return failure;
}

std::vector<PluginListing> list_plugins(const SearchPath& search_path) {
  std::vector<PluginListing> list;
  for (const SearchPath::File& file : search_path.files()) {
    PluginListing entry;
    entry.id = file.id;
    entry.path = file.path;
    entry.origin = file.place->origin;
    if (file.hidden_by) entry.hidden_by = file.hidden_by->path;
    try {
      entry.plugin = &open_plugin_file(file.path, file.id);
    } catch (const LoadFailure& failure) {
      entry.failure = failure.what();
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace shoal::kernel
