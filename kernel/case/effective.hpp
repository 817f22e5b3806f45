// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The effective case: what was computed, with every default and where each value came from, as a case that gives the
// same model when it is read again.
#pragma once

#include <string>

#include "kernel/case/model.hpp"

namespace shoal::kernel {

/// Numbers are in SI units and exact. Each line ends in its unit and origin: "# m, dam_break.yaml:12", "# default",
/// "# --set".
std::string effective_case(const CaseModel& model);

/// A text as YAML, in quotes where it needs them.
std::string yaml_text(const std::string& text);

}  // namespace shoal::kernel
