// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a plugin's stamp out of its file, without running any of its code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kernel/plugins/errors.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// The constant `shoal_plugin_stamp` as it stands in the file, in the layout of this kernel, or what is wrong
/// with the file. Members that its maker did not know are zero.
struct StampReading {
  std::optional<shoal_stamp> stamp;
  LoadProblem problem = LoadProblem::no_stamp;  ///< if there is no stamp
  std::string text;  ///< end of a sentence that begins with the file: "is a folder"
};
StampReading read_stamp(const std::filesystem::path& path);

}  // namespace shoal::kernel
