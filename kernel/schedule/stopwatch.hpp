// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Time between actions: one reading of the clock (about 25 ns) both ends an action and begins the next.
#pragma once

#include <chrono>
#include <cstdint>

namespace shoal::kernel {

class Stopwatch {
 public:
  static std::uint64_t now() {
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                          std::chrono::steady_clock::now().time_since_epoch())
                                          .count());
  }
  void start() { last_ = now(); }
  /// Nanoseconds since the last call of start or lap.
  std::uint64_t lap() {
    const std::uint64_t present = now();
    const std::uint64_t passed = present - last_;
    last_ = present;
    return passed;
  }

 private:
  std::uint64_t last_ = now();
};

}  // namespace shoal::kernel
