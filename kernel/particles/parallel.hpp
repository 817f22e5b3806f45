// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How the kernel spreads work over threads. Pieces never depend on the number of threads, and little work stays on
// the calling thread: waking others costs more than a few thousand particles do.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <cstdint>

namespace shoal::kernel {

/// Particles in a chunk of an operator's work.
inline constexpr std::uint64_t chunk_size = 128;
/// Below this many particles everything runs on the calling thread, but for operators whose calls have taken long enough
/// so far: a pass over pairs of 1000 particles gains by a second thread, and so do those at the walls of 3000 (0.7 of the
/// time in dam_break_2d on an idle machine).
inline constexpr std::uint64_t serial_below = 5000;
inline constexpr std::uint64_t worth_threads = 12'000;  ///< of one call, ns

constexpr std::uint64_t n_chunks(std::uint64_t n) { return (n + chunk_size - 1) / chunk_size; }

/// function(begin, end) for pieces of 0..n that are multiples of SHOAL_PADDING but for the last one.
template <class Function>
void for_each_range(std::uint64_t n, const Function& function) {
  if (n < serial_below) {
    if (n > 0) function(std::uint64_t{0}, n);
    return;
  }
  constexpr std::uint64_t piece = 2048;
  tbb::parallel_for(
      tbb::blocked_range<std::uint64_t>(0, (n + piece - 1) / piece),
      [&](const tbb::blocked_range<std::uint64_t>& range) {
        function(range.begin() * piece, std::min(n, range.end() * piece));
      },
      tbb::static_partitioner{});
}

}  // namespace shoal::kernel
