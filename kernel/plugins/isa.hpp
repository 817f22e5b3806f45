// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Instruction sets: what a plugin's code needs against what this machine has.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::kernel {

/// SHOAL_ISA_* bits of the processor and operating system that this runs on.
std::uint32_t isa_of_machine();

/// "AVX2, FMA"; bits without a name as "bit 31".
std::string isa_text(std::uint32_t bits);

/// Empty if `needed` can run on `available`, else the end of a sentence that begins with "plugin 'x'" and
/// says how to build for this machine.
std::string isa_problem(std::uint32_t needed, std::uint32_t available);

}  // namespace shoal::kernel
