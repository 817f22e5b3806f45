// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How the kernel spreads work over threads. Pieces never depend on the number of threads, and little work stays on
// the calling thread: waking others costs more than a few thousand particles do.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "kernel/neighbours/threads.hpp"

namespace shoal::kernel {

/// Particles in a chunk of an operator's work.
inline constexpr std::uint64_t chunk_size = 128;
/// Below this many particles everything runs on the calling thread, but for operators whose calls have taken long enough
/// so far: a pass over pairs of 1000 particles gains by a second thread, and so do those at the walls of 3000 (0.7 of the
/// time in dam_break_2d on an idle machine).
inline constexpr std::uint64_t serial_below = 5000;
inline constexpr std::uint64_t worth_threads = 12'000;  ///< of one call, ns

constexpr std::uint64_t n_chunks(std::uint64_t n) { return (n + chunk_size - 1) / chunk_size; }

/// piece(k) for k = 0 ... n - 1, on all threads. Each has a share of neighbouring pieces, the same in each loop, so that
/// what they hold stays in its cache; one that is done takes pieces of others, since they take unequal times (there is
/// more to do at walls, less at surfaces and in spray), and so do cores on which other programs run.
template <class Piece>
void for_each_piece(std::uint64_t n, const Piece& piece) {
  struct alignas(64) Share {
    std::atomic<std::uint64_t> next;
    std::uint64_t end;
  };
  const std::uint64_t threads = std::min<std::uint64_t>(available_threads(), n);
  std::vector<Share> shares(threads);
  for (std::uint64_t k = 0; k < threads; ++k) {
    shares[k].next.store(k * n / threads, std::memory_order_relaxed);
    shares[k].end = (k + 1) * n / threads;
  }
  tbb::parallel_for(
      std::uint64_t{0}, threads,
      [&](std::uint64_t thread) {
        for (std::uint64_t k = 0; k < threads; ++k) {
          Share& share = shares[(thread + k) % threads];
          for (;;) {
            const std::uint64_t next = share.next.fetch_add(1, std::memory_order_relaxed);
            if (next >= share.end) break;
            piece(next);
          }
        }
      },
      tbb::static_partitioner{});
}

/// function(begin, end) for pieces of 0..n that are multiples of SHOAL_PADDING but for the last one.
template <class Function>
void for_each_range(std::uint64_t n, const Function& function) {
  if (n < serial_below) {
    if (n > 0) function(std::uint64_t{0}, n);
    return;
  }
  constexpr std::uint64_t piece = 2048;
  for_each_piece((n + piece - 1) / piece,
                 [&](std::uint64_t k) { function(k * piece, std::min(n, (k + 1) * piece)); });
}

}  // namespace shoal::kernel
