// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a step of diffusion costs, by which `integrator: auto` chooses. The figures were measured once, on one core of an
// AVX-512 Xeon at 2.1 GHz, ns per particle
// (several turns gave 1.35 to 1.68 per neighbour, and 6 to 12 more per particle):
//   ctest --test-dir build/release -L bench -R 'bench.diffusion|reaction.bench' -V
// Only their ratios count. Clocks of the run itself would choose by the machine as it is at that moment: the choice, and
// with it the last digits of the result, would then depend on threads, on who else computes, and on where a run was
// stopped and resumed. With figures measured beforehand and counts of the case it is the same everywhere, and the error
// that a machine with other ratios makes is bounded, since a wrong choice is one between costs that are close: over steps
// of 1 to 31 times the longest of rk2 and any amount of other work, a ratio of the rate to the rest that is wrong by a
// factor of 2 costs at most 7.5 % of the step, one by a factor of 4 at most 15 % (integrator_test.cpp: "a wrong ratio").
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "shoal/physics.hpp"

namespace shoal::diffusion {

namespace measured {
inline constexpr double rate = 10.0, rate_per_neighbour = 1.5;  // diffusion.rate
inline constexpr double expressions = 6.0;                      // of surface data or sources, each
inline constexpr double rk2_stage = 1.4, rkl2_stage = 2.1, rkl2_error = 6.0;
inline constexpr double watch = 3.0;              // diffusion.watch, once in a step
inline constexpr double reaction_variable = 7.0;  // of half a step of a reaction
}  // namespace measured

// What else is done in each step of the loop `diffusion`; physics of one model share it.
struct OtherWork {
  double ns = 0;                                                  // in a step
  double longest_step = std::numeric_limits<double>::infinity();  // s, that it allows

  static std::shared_ptr<OtherWork> of(const Builder& builder) {  // [main]
    static std::map<const void*, std::weak_ptr<OtherWork>> known;
    std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<OtherWork>& entry = known[builder.raw().context];
    std::shared_ptr<OtherWork> work = entry.lock();
    if (!work) entry = work = std::make_shared<OtherWork>();
    return work;
  }
};

// Of one field, ns.
struct StepCost {
  double rate = 0, rk2_stage = 0, rkl2_stage = 0, rkl2_error = 0, other = 0;

  // `expressions`: kinds of them that each evaluation of the rate looks up.
  StepCost() = default;
  StepCost(double particles, double neighbours, int expressions, double other_ns)
      : rate(measured::rate_per_neighbour * neighbours +
             particles * (measured::rate + expressions * measured::expressions)),
        rk2_stage(particles * measured::rk2_stage),
        rkl2_stage(particles * measured::rkl2_stage),
        rkl2_error(particles * measured::rkl2_error),
        other(particles * measured::watch + other_ns) {}

  double rk2() const { return 2.0 * (rate + rk2_stage) + other; }
  double rkl2(int stages) const { return stages * (rate + rkl2_stage) + rkl2_error + other; }
};

}  // namespace shoal::diffusion
