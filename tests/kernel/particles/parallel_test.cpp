// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/particles/parallel.hpp"

#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

using namespace shoal::kernel;

TEST_CASE("each piece is done once, however many threads there are and however long pieces take") {
  for (const int threads : {1, 2, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    for (const std::uint64_t n : {0u, 1u, 3u, 1000u}) {
      std::vector<std::atomic<int>> done(n);
      arena.execute([&] {
        for_each_piece(n, [&](std::uint64_t k) {
          // All that takes long lies in the first thread's share.
          if (k < n / 8) std::this_thread::sleep_for(std::chrono::microseconds(20));
          ++done[k];
        });
      });
      for (const auto& times : done) CHECK(times == 1);
    }
  }
}
