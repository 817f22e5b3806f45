// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The search for plugins. Folders are read only when somebody asks what is there; finding one plugin is one
// stat for each place.
#include "kernel/plugins/search_path.hpp"

#include <stdlib.h>  // secure_getenv

#include <algorithm>
#include <map>
#include <system_error>

#include "kernel/build_info.hpp"

namespace shoal::kernel {
namespace fs = std::filesystem;

bool is_snake_case(std::string_view text) {
  if (text.empty() || text.front() < 'a' || text.front() > 'z') return false;
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

SearchSettings SearchSettings::of_this_process() {
  SearchSettings settings;
  if (const char* text = ::secure_getenv("SHOAL_PLUGIN_PATH")) settings.environment = text;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) settings.program_folder = program.parent_path();
  return settings;
}

SearchPath::SearchPath(const SearchSettings& settings) {
  for (const fs::path& folder : settings.command_line) add(folder, "--plugin-path");
  for (const fs::path& folder : settings.of_case) add(folder, "the case", settings.allow_plugin_paths);
  std::string_view rest = settings.environment;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    // An empty entry is no folder: in PATH it would mean the current one, where strangers may put files.
    if (!folder.empty()) add(folder, "SHOAL_PLUGIN_PATH");
  }
  if (!settings.program_folder.empty()) {
    add(settings.program_folder / build_info::plugins_of_build_tree, "build tree");
    add(settings.program_folder / build_info::plugins_installed, "installation");
  }
}

void SearchPath::add(const fs::path& folder, const std::string& origin, bool allowed) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(folder, error);
  if (error) path = folder;
  for (const Place& place : places_)
    if (place.folder == path && place.allowed) return;
  places_.push_back({path, origin, allowed, fs::is_directory(path, error)});
}

std::optional<fs::path> SearchPath::find(std::string_view id) const {
  for (const Place& place : places_) {
    if (!place.allowed || !place.exists) continue;
    fs::path path = place.folder / (std::string(id) + ".so");
    std::error_code error;
    // Also what cannot be looked at counts as found: it is then reported, not passed over.
    if (fs::symlink_status(path, error).type() != fs::file_type::not_found) return path;
  }
  return std::nullopt;
}

const std::vector<SearchPath::File>& SearchPath::files() const {
  if (files_) return *files_;
  std::vector<File> files;
  for (const Place& place : places_) {
    if (!place.allowed || !place.exists) continue;
    std::vector<File> here;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(place.folder, error)) {
      const fs::path& path = entry.path();
      if (path.extension() == ".so" && is_snake_case(path.stem().string()))
        here.push_back({path.stem().string(), path, &place, nullptr});
    }
    std::sort(here.begin(), here.end(), [](const File& a, const File& b) { return a.id < b.id; });
    files.insert(files.end(), here.begin(), here.end());
  }
  files_ = std::move(files);
  std::map<std::string_view, const File*> first;
  for (File& file : *files_) {
    const auto [known, is_new] = first.emplace(file.id, &file);
    if (!is_new) file.hidden_by = known->second;
  }
  return *files_;
}

std::vector<std::string> SearchPath::available() const {
  std::vector<std::string> ids;
  for (const File& file : files())
    if (!file.hidden_by) ids.push_back(file.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<std::string> SearchPath::description() const {
  std::vector<std::string> lines;
  for (const Place& place : places_) {
    std::string line = place.folder.string() + " (" + place.origin;
    if (!place.allowed)
      line += "; not searched: a case may name folders only with --allow-plugin-paths";
    else if (!place.exists)
      line += "; no such folder";
    lines.push_back(line + ")");
  }
  return lines;
}

}  // namespace shoal::kernel
