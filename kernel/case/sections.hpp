// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The sections of a case, described by the same tables as the types of plugins.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernel/case/schema.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

// Kinds of values that only the kernel's own tables use.
inline constexpr std::uint32_t kind_parameters = 0x10001;  ///< map of names to numbers: class Parameters
inline constexpr std::uint32_t kind_section = 0x10002;     ///< a map with a table of its own
inline constexpr std::uint32_t kind_named_items =
    0x10003;  ///< map of names, chosen by the user, to such maps
inline constexpr std::uint32_t kind_listed_items = 0x10004;  ///< list of such maps
inline constexpr std::uint32_t kind_number_map = 0x10005;    ///< map of words to numbers
inline constexpr std::uint32_t kind_field_map = 0x10006;  ///< map of fields to expressions, one per component

/// The top level of a case. Its values of the kinds above are read by model.cpp.
const shoal_type& case_table();
/// What a key of the top level holds: run, domain, smoothing, body (of bodies), probe (of probes), reference.
/// Null for other keys.
const shoal_type* section_table(std::string_view key);

/// All tables of the kernel, for `shoal describe`.
std::vector<const shoal_type*> section_tables();

/// Keys of the top level.
std::vector<std::string> section_keys();

}  // namespace shoal::kernel
