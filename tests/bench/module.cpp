// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// OnePass as a plugin gives it to the kernel: a table of C callbacks out of a library that is opened at run time.
#include <memory>

#include "one_pass.hpp"
#include "shoal/plugin.hpp"

using shoal::bench::Constants;
using shoal::bench::OnePass;

// An operator for body 0 with itself as neighbours; the caller destroys it.
extern "C" SHOAL_EXPORT shoal_operator bench_operator(double smoothing_length, double cutoff,
                                                      Constants constants) {
  auto attached = std::make_unique<shoal::impl::AttachedOperator<OnePass>>();
  attached->name = "bench.one_pass";
  shoal::Target target;
  target.neighbours = {{0}};
  target.smoothing_length = smoothing_length;
  target.cutoff = cutoff;
  attached->op.set_target(target);
  attached->op.set_dimensions(3);
  attached->op.constants = constants;
  return shoal::impl::describe(std::move(attached), 0);
}
