// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// All particles as CSV, one file per body: what is left of a failed run whose case writes no pictures. ParaView opens
// it (filter Table To Points).
#pragma once

#include <filesystem>

#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel {

/// Throws OutputError.
void dump_tables(const Simulation& run, const std::filesystem::path& folder);

}  // namespace shoal::kernel
