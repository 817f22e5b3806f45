// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Opens one plugin's file: checks its stamp, maps it, calls its entry once, and checks what it says of
// itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/plugins/errors.hpp"
#include "kernel/plugins/version.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

struct Requirement {
  std::string id;
  VersionRange versions;
};

/// A plugin that is in this process, and stays until its end.
struct LoadedPlugin {
  std::string id;
  std::string version_text;
  Version version;
  std::string licence;
  std::string summary;
  std::string citation;  ///< empty if it names none
  std::filesystem::path path;
  shoal_stamp stamp{};
  std::vector<Requirement> requirements;
  std::vector<const shoal_type*> types;  ///< as the plugin made them: see abi_reading.hpp
};

/// What is wrong with a stamp for a kernel of version `major` on a machine with `isa`; nothing if all is
/// well. The text is the end of a sentence that begins with the plugin. Any minor of the same major is well.
struct StampProblem {
  LoadProblem problem;
  std::string text;
};
std::optional<StampProblem> check_stamp(const shoal_stamp& stamp, unsigned major, unsigned minor,
                                        std::uint32_t isa);

/// Opens `path` as plugin `id`; throws LoadFailure. Nothing of the library runs before its stamp is accepted.
/// A file is opened once in a process: a second call gives the same plugin, or the same failure. [main
/// thread]
const LoadedPlugin& open_plugin_file(const std::filesystem::path& path, const std::string& id);

}  // namespace shoal::kernel
