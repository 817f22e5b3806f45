// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Passes over pairs that need not take place in every step of their loop.
#pragma once

#include <cstdint>

#include "shoal/pair_operator.hpp"

namespace shoal::fluid {

// A pair operator that works in step 0, `interval`, 2 `interval`, ... and leaves everything as it is in the others.
template <class Derived>
struct IntermittentPairOperator : PairOperator<Derived> {
  std::uint64_t interval = 1;

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (works()) PairOperator<Derived>::template run_chunk<D>(chunk);
  }
  template <int D>
  void prepare_chunk(const shoal_chunk& chunk) const {
    if (works()) PairOperator<Derived>::template prepare_chunk<D>(chunk);
  }

 private:
  bool works() const { return this->step().number % interval == 0; }
};

}  // namespace shoal::fluid
