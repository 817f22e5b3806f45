// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tables say, for people (`shoal describe`) and for editors (JSON schema).
#pragma once

#include <string>
#include <vector>

#include "kernel/case/schema.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// A type or section with all its keys in aligned columns, at most `width` columns wide. `owner` is said in the
/// first line, e.g. "material of plugin fluid 1.0"; empty: the kind alone.
std::string describe_type(const shoal_type& type, const std::string& owner = {}, int width = 100);

/// The JSON schema of a whole case, for the completion and checks of editors. `types` are all that may be named.
std::string json_schema(const std::vector<const shoal_type*>& types);

}  // namespace shoal::kernel
