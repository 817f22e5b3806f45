// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// diffusion.stimulus: adds a constant rate to the first variable of a reaction, in a region and for a time, once or
// again and again. A step that the stimulus begins or ends in gets the part of it that falls into the step; a particle
// gets the part of its cell, a square or cube of one spacing, that lies in the box: so the volume that is stimulated does
// not depend on how the box cuts the particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "shoal/material.hpp"

namespace shoal::diffusion {

struct Stimulus final : Material {
  Param<double> rate{
      "rate", "1",
      "What is added to the first variable per second, in SI units of the variable; of a current per "
      "volume in A/m3 that divided by the membrane's area per volume and its capacitance.",
      example("35.7")};
  Param<double> start{"start", "s", "When it begins.", non_negative, default_to(0.0)};
  Param<double> duration{"duration", "s", "How long it lasts.", positive, example("2 ms")};
  Param<double> period{"period", "s",      "Time from one beginning to the next; without it there is one.",
                       positive, optional, example("1 s")};
  Param<Vector3> lower{"lower", "m",
                       "Lower corner of the box in which it acts; without it there is no bound.", optional,
                       example("[0, 0]")};
  Param<Vector3> upper{"upper", "m",
                       "Upper corner of the box in which it acts; without it there is no bound.", optional,
                       example("[1.5 mm, 1.5 mm]")};
  Param<Expression> where{
      "where", "1",
      "Acts where this is not zero (and inside the box, if there is one); a value between 0 and 1 "
      "weakens it.",
      optional, example("hypot(x, y) < 0.01")};

  void validate() const {
    if (period.is_set() && period < duration)
      throw CaseError(period.place() +
                      ": the period is shorter than the duration; a stimulus must end before it "
                      "begins again");
    if (lower.is_set() && upper.is_set())
      for (std::size_t a = 0; a < 3; ++a)
        if (lower.value()[a] > upper.value()[a])
          throw CaseError(upper.place() + ": the upper corner lies below the lower one; swap them");
  }

  // The part of the time from t0 to t1 in which it acts.
  double share(double t0, double t1) const {
    if (!(t1 > t0)) return 0.0;
    const double whole = period.is_set() ? period.value() : HUGE_VAL;
    const double n = period.is_set() ? std::max(0.0, std::floor((t0 - start) / whole)) : 0.0;
    double time = 0;
    for (int k = 0; k < (period.is_set() ? 2 : 1); ++k) {
      const double begin = start + (period.is_set() ? (n + k) * whole : 0.0);
      time += std::max(0.0, std::min(t1, begin + duration) - std::max(t0, begin));
    }
    return time / (t1 - t0);
  }

  // Adds the mean rate from t0 to t1 at n particles `width` apart, in m.
  void add(int dimensions, double width, std::uint64_t n, const double* position, double t0, double t1,
           double* source) const {
    const double strength = rate * share(t0, t1);
    std::vector<double> factor;
    if (where.is_set()) {
      factor.resize(n);
      where->evaluate(dimensions, n, position, 0.5 * (t0 + t1), factor.data());
    }
    for (std::uint64_t i = 0; i < n; ++i)
      source[i] += strength *
                   inside(dimensions, width, position + i * static_cast<std::uint64_t>(dimensions)) *
                   (factor.empty() ? 1.0 : factor[i]);
  }

  // The part of a cell around x that lies between `low` and `high`, along one axis.
  static double overlap(double x, double width, double low, double high) {
    const double below = std::max(0.0, low - (x - 0.5 * width));
    const double above = std::max(0.0, x + 0.5 * width - high);
    return std::max(0.0, 1.0 - (below + above) / width);
  }

 private:
  // The part of a particle's cell in the box.
  double inside(int dimensions, double width, const double* x) const {
    double part = 1.0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimensions); ++a)
      part *= overlap(x[a], width, lower.is_set() ? lower.value()[a] : -HUGE_VAL,
                      upper.is_set() ? upper.value()[a] : HUGE_VAL);
    return part;
  }
};

}  // namespace shoal::diffusion
