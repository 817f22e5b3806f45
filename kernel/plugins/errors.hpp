// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What goes wrong between the kernel and a plugin, as exceptions. These name no place of a case: whoever
// reads the case knows at which line a plugin was asked for and adds it.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "shoal/abi.h"

namespace shoal::kernel {

/// Why a plugin cannot be loaded, for tests and machines; people read the text.
enum class LoadProblem {
  bad_id,
  not_found,
  not_a_file,
  not_a_library,
  truncated,
  other_machine,
  no_stamp,
  bad_stamp,
  abi_major,
  other_sizes,
  isa,
  missing_library,
  undefined_symbol,
  not_loadable,
  no_entry,
  entry_failed,
  bad_description,
  other_id,
  requirement,
  version,
  cycle
};

/// A plugin that was asked for and cannot be had. `what()` is one sentence without a full stop.
class LoadFailure : public std::runtime_error {
 public:
  LoadFailure(LoadProblem problem, std::string id, std::filesystem::path path, const std::string& text,
              std::vector<std::string> notes = {})
      : std::runtime_error(text),
        problem_(problem),
        id_(std::move(id)),
        path_(std::move(path)),
        notes_(std::move(notes)) {}

  LoadProblem problem() const { return problem_; }
  const std::string& id() const { return id_; }
  const std::filesystem::path& path() const { return path_; }  ///< empty if no file was found
  const std::vector<std::string>& notes() const {
    return notes_;
  }  ///< further lines, e.g. the places searched

  /// Plugins that are present where `id` was not found: what a misspelt id is to be compared with.
  const std::vector<std::string>& available() const { return available_; }
  void set_available(std::vector<std::string> ids) { available_ = std::move(ids); }

 private:
  LoadProblem problem_;
  std::string id_;
  std::filesystem::path path_;
  std::vector<std::string> notes_;
  std::vector<std::string> available_;
};

/// A plugin whose tables of types and parameters are wrong: a fault of its author, all of it at once.
class TableError : public std::runtime_error {
 public:
  TableError(std::string plugin, const std::filesystem::path& path, std::vector<std::string> problems);
  const std::string& plugin() const { return plugin_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::string plugin_;
  std::vector<std::string> problems_;
};

/// A callback of a plugin returned another status than SHOAL_OK; the status says whose fault it is.
class PluginFailure : public std::runtime_error {
 public:
  PluginFailure(std::string plugin, std::string type, shoal_status status, std::string text)
      : std::runtime_error((type.empty() ? plugin : type) + ": " + text),
        plugin_(std::move(plugin)),
        type_(std::move(type)),
        text_(std::move(text)),
        status_(status) {}

  const std::string& plugin() const { return plugin_; }  ///< its id
  const std::string& type() const { return type_; }      ///< e.g. "fluid.viscous_force"; may be empty
  const std::string& text() const { return text_; }      ///< what the plugin said
  shoal_status status() const { return status_; }        ///< ERROR, CASE_ERROR or PHYSICS_FAILED

 private:
  std::string plugin_, type_, text_;
  shoal_status status_;
};

}  // namespace shoal::kernel
