// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// From what physics declared to a schedule that runs.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/schedule/declarations.hpp"
#include "kernel/schedule/neighbourhood.hpp"
#include "kernel/schedule/schedule.hpp"

namespace shoal::kernel {

/// Consumes the attachments of `declarations`. Declares fields in the bodies and relations in the neighbourhood.
/// Throws ModelError with the known names where one is unknown.
Schedule resolve(Declarations& declarations, std::vector<std::unique_ptr<Body>>& bodies,
                 Neighbourhood& neighbourhood, const std::map<std::string, double>& time_step_factors);

/// "'a', 'b' and 'c'", or "none"
std::string quoted_list(const std::vector<std::string>& words);

}  // namespace shoal::kernel
