// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where plugins are looked for, in which order, and what is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::kernel {

/// Folders by who named them, in the order of the search.
struct SearchSettings {
  std::vector<std::filesystem::path> command_line;  ///< --plugin-path
  std::vector<std::filesystem::path> of_case;       ///< written in the case
  bool allow_plugin_paths = false;       ///< a case may not run code of its own unless the user says so
  std::string environment;               ///< SHOAL_PLUGIN_PATH: folders separated by ':'
  std::filesystem::path program_folder;  ///< plugins stand beside it (build tree, installation)

  /// Environment and folder of the running program; the rest empty. A program with raised rights
  /// (set-user-id) does not see the environment.
  static SearchSettings of_this_process();
};

class SearchPath {
 public:
  struct Place {
    std::filesystem::path folder;
    std::string origin;  ///< "--plugin-path", "SHOAL_PLUGIN_PATH", ...
    bool allowed = true;
    bool exists = false;
  };
  struct File {
    std::string id;
    std::filesystem::path path;
    const Place* place;
    const File* hidden_by;  ///< the file of the same id in an earlier place, or null
  };

  explicit SearchPath(const SearchSettings& settings);
  // Files point into places.
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

  const std::vector<Place>& places() const { return places_; }

  /// The file `<id>.so` in the first place that has one, whatever it is.
  std::optional<std::filesystem::path> find(std::string_view id) const;

  /// All `*.so` with names that can be ids, by place, then by id.
  std::vector<std::string> available() const;
  const std::vector<File>& files() const;

  /// One line for each place: folder, who named it, and whether it was looked at.
  std::vector<std::string> description() const;

 private:
  void add(const std::filesystem::path& folder, const std::string& origin, bool allowed = true);
  std::vector<Place> places_;
  mutable std::optional<std::vector<File>> files_;
};

/// Whether a text can be a plugin's id: snake_case, as fluid.
bool is_snake_case(std::string_view text);

}  // namespace shoal::kernel
