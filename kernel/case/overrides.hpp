// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Settings of the command line, --set PATH=VALUE, applied to the tree before it is checked, so that they meet the
// same checks as the file.
#pragma once

#include <string>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/yaml_reader.hpp"

namespace shoal::kernel {

/// `settings` are texts "run.end=1", "H=0.5m", "physics.fluid.wcsph.viscosity=1e-3", "probes.0.every=1 ms". A path
/// goes through keys, places of list items (0, 1, ...) and names of types; a single word that is a parameter means
/// parameters.WORD. A key that the file leaves out is added. `sections` are the keys that may stand at the top
/// level. What is set has the place "<--set run.end=1>".
Node apply_overrides(const Node& root, const std::vector<std::string>& settings,
                     const std::vector<std::string>& sections, Diagnostics& diagnostics);

/// The place of a value that was set by --set, for other settings of the command line too.
Place command_line_place(const std::string& setting);

/// Whether a place is one of the command line.
bool is_command_line(const Place& place);

}  // namespace shoal::kernel
