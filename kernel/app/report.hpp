// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What people read of a run: its plan, its cost, and how well it did.
#pragma once

#include <string>

#include "kernel/output/summary.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/schedule/plan.hpp"

namespace shoal::kernel::app {

/// The tree of loops, stages and operators; relations; fields with bytes per particle; memory.
std::string plan_text(const Plan& plan);
/// Bodies and particles in a line each, for the beginning of a run.
std::string bodies_text(const Plan& plan);
/// Operators by their time, neighbour search, overhead, rates and memory.
std::string timings_text(const Summary& summary);
std::string references_text(const std::vector<ReferenceResult>& results);
/// The cause and the worst particles.
std::string failure_text(const PhysicsFailure::Report& report);

}  // namespace shoal::kernel::app
