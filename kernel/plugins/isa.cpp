// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Instruction sets of the machine, asked from the processor once.
#include "kernel/plugins/isa.hpp"

#include <array>

#include "shoal/abi.h"

namespace shoal::kernel {
namespace {

struct Name {
  std::uint32_t bit;
  const char* text;
};
constexpr std::array<Name, 6> names{{{SHOAL_ISA_AVX2, "AVX2"},
                                     {SHOAL_ISA_FMA, "FMA"},
                                     {SHOAL_ISA_AVX512F, "AVX-512F"},
                                     {SHOAL_ISA_AVX512DQ, "AVX-512DQ"},
                                     {SHOAL_ISA_AVX512VL, "AVX-512VL"},
                                     {SHOAL_ISA_AVX512BW, "AVX-512BW"}}};

std::uint32_t ask_processor() {
  std::uint32_t isa = 0;
#if defined(__x86_64__)
  __builtin_cpu_init();
  // The builtin takes nothing but literals.
  if (__builtin_cpu_supports("avx2")) isa |= SHOAL_ISA_AVX2;
  if (__builtin_cpu_supports("fma")) isa |= SHOAL_ISA_FMA;
  if (__builtin_cpu_supports("avx512f")) isa |= SHOAL_ISA_AVX512F;
  if (__builtin_cpu_supports("avx512dq")) isa |= SHOAL_ISA_AVX512DQ;
  if (__builtin_cpu_supports("avx512vl")) isa |= SHOAL_ISA_AVX512VL;
  if (__builtin_cpu_supports("avx512bw")) isa |= SHOAL_ISA_AVX512BW;
#endif
  return isa;
}

}  // namespace

std::uint32_t isa_of_machine() {
  static const std::uint32_t isa = ask_processor();
  return isa;
}

std::string isa_text(std::uint32_t bits) {
  std::string text;
  for (std::uint32_t shift = 0; shift < 32; ++shift) {
    const std::uint32_t bit = 1u << shift;
    if (!(bits & bit)) continue;
    std::string word = "bit " + std::to_string(shift);
    for (const Name& name : names)
      if (name.bit == bit) word = name.text;
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::string isa_problem(std::uint32_t needed, std::uint32_t available) {
  const std::uint32_t missing = needed & ~available;
  if (missing == 0) return {};
  std::uint32_t known = 0;
  for (const Name& name : names) known |= name.bit;
  if (missing & ~known)
    return "needs an instruction set that this version of Shoal does not know (" +
           isa_text(missing & ~known) + "); use a newer Shoal";
  const bool portable_runs = ((SHOAL_ISA_AVX2 | SHOAL_ISA_FMA) & ~available) == 0;
  return "was built for a processor with " + isa_text(missing) +
         ", which this machine does not have; build it here with 'cmake --preset release && cmake --build "
         "--preset release'" +
         (portable_runs ? ", or with the preset 'portable', which needs AVX2 and FMA alone"
                        : " (the preset 'portable' needs AVX2 and FMA, which are missing here too)");
}

}  // namespace shoal::kernel
