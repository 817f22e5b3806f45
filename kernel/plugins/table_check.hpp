// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What is wrong with a plugin's table of a type: found when it is registered, so that its author sees it at
// the first start, and readers of cases, docs and schema can rely on the tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shoal/abi.h"

namespace shoal::kernel {

/// A deeper check of one parameter, by those who can parse units and expressions; empty if all is well.
using ParameterCheck = std::function<std::string(const shoal_parameter&)>;

/// "physics", "material", ...; "kind 17" if it has no name.
std::string kind_text(std::uint32_t kind);
std::string value_kind_text(std::uint32_t kind);

/// Whether this kernel knows the kinds of the type and of its parameters: a newer minor may have more.
bool is_known(const shoal_type& type);

/// Problems of a type of plugin `id` (empty: of the kernel itself, whose types have no prefix), each a phrase
/// that names the type and the key. `type` is as its maker made it.
std::vector<std::string> check_type(const shoal_type& type, const std::string& id,
                                    const ParameterCheck& deeper);

}  // namespace shoal::kernel
