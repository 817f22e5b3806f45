// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// When an output, a probe or a checkpoint is due. Nothing is due between steps, and no step is shortened for it: what
// is written must not change what is computed. So each due time is served at the first step at or after it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace shoal::kernel {

class Due {
 public:
  Due() = default;
  /// Multiples of `every` (0 among them), and the times `at`; in s.
  Due(std::optional<double> every, std::vector<double> at) : every_(every), at_(std::move(at)) {
    std::sort(at_.begin(), at_.end());
  }

  /// Whether a time that is due lies in (last, now]; `last` is the time of the previous question.
  bool between(double last, double now) const { return count(now) > count(last); }
  /// Whether something is due at or before the start of a run.
  bool at_start(double now) const { return count(now) > 0; }

 private:
  // Due times up to `time`. As a pure function of time it needs no state in checkpoints.
  double count(double time) const {
    double n = 0.0;
    // Sums of steps miss multiples of `every` by rounding.
    if (every_ && time >= 0.0) n += std::floor(time / *every_ + 1e-9) + 1.0;
    for (const double at : at_) n += time >= at - 1e-12 * std::abs(at) ? 1.0 : 0.0;
    return n;
  }

  std::optional<double> every_;
  std::vector<double> at_;
};

}  // namespace shoal::kernel
