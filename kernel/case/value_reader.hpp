// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Single values of a parameter table, kind by kind; the part of schema.hpp that nobody else needs.
#pragma once

#include <string>

#include "kernel/case/schema.hpp"

namespace shoal::kernel {

/// What is wrong with a default or an example apart from names that only a case can know (parameters, bodies,
/// files, types). Empty if all is well.
std::string check_text_of(const shoal_parameter& parameter, const Node& node);

}  // namespace shoal::kernel
