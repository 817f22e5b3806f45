// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads the plugins that a case asks for, and those that they require, and nothing else.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/plugins/plugin_file.hpp"
#include "kernel/plugins/search_path.hpp"

namespace shoal::kernel {

class Loader {
 public:
  explicit Loader(const SearchSettings& settings) : search_path_(settings) {}

  /// The plugin `id` with everything that it requires. Throws LoadFailure; asked again, it gives the same
  /// answer. What was loaded before a failure stays in `loaded()` only if it was itself complete. [main
  /// thread]
  const LoadedPlugin& load(const std::string& id, const VersionRange& versions = {});

  /// In the order in which they may be registered: each after those that it requires.
  const std::vector<const LoadedPlugin*>& loaded() const { return loaded_; }
  bool is_loaded(std::string_view id) const;

  const SearchPath& search_path() const { return search_path_; }

 private:
  const LoadedPlugin& load(const std::string& id, std::vector<std::string>& chain);
  const LoadedPlugin& load_new(const std::string& id, std::vector<std::string>& chain);
  void load_requirements(const LoadedPlugin& plugin, std::vector<std::string>& chain);
  LoadFailure not_found(const std::string& id) const;

  SearchPath search_path_;
  std::vector<const LoadedPlugin*> loaded_;
  std::map<std::string, LoadFailure> failures_;
};

/// What `shoal plugins` shows of one file.
struct PluginListing {
  std::string id;
  std::filesystem::path path;
  std::string origin;               ///< who named its folder
  std::filesystem::path hidden_by;  ///< the file that is taken instead; empty if this one is
  const LoadedPlugin* plugin = nullptr;
  std::string failure;  ///< why it cannot be loaded; empty if it can
};

/// Opens every plugin in the search path, so it runs code of all of them; requirements are not looked at.
/// In the order of the search, then by id. [main thread]
std::vector<PluginListing> list_plugins(const SearchPath& search_path);

}  // namespace shoal::kernel
