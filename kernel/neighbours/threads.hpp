// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// When a loop over n particles is worth more than one thread: small bodies run serially, since waking threads costs
// more than they save.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace shoal::kernel {

inline std::size_t available_threads() {
  const auto arena = static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
  return std::min(arena, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

inline bool use_threads(std::size_t n) { return n >= 4096 && available_threads() > 1; }
/// For the rows of a neighbour list, each of which takes as long as some ten particles in other loops. Handing blocks to
/// two threads costs what some 1200 rows in 2D do.
inline bool use_threads_for_rows(std::size_t n) { return n >= 2048 && available_threads() > 1; }

}  // namespace shoal::kernel
