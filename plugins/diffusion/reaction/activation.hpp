// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// When a particle is excited: upward crossings of a threshold by the reaction's first variable, linear within the step.
// Fields for who asks for them:
//   activation_time      first crossing, s; -1 before
//   last_activation      last crossing, s; -1 before the first
//   activations          number of crossings
//   mean_cycle_length    (last - first crossing) / (their number - 1), s; 0 before the second
#pragma once

#include <memory>

#include "shoal/interfaces/reaction_model.h"
#include "shoal/particle_operator.hpp"

namespace shoal::diffusion {

namespace impl {
inline constexpr Doc first_doc{
    "Time at which the reaction's first variable first rose through the threshold; -1 where it has not yet."};
inline constexpr Doc last_doc{
    "Time at which the reaction's first variable last rose through the threshold; -1 where it has not yet."};
inline constexpr Doc number_doc{"How often the reaction's first variable has risen through the threshold."};
inline constexpr Doc cycle_doc{"Mean time between two activations."};
inline constexpr Doc before_doc{"First variable of the reaction one step before."};
}  // namespace impl

// Before the first step.
struct NotActivated : ParticleOperator<NotActivated> {
  In<Scalar> potential{"potential"};
  std::unique_ptr<Out<Scalar>> before;
  Out<Scalar> first{"activation_time", unit("s"), impl::first_doc};
  Out<Scalar> last{"last_activation", unit("s"), impl::last_doc};

  void set(const shoal_reaction_variable& variable) {
    potential.rename(variable.name);
    before = std::make_unique<Out<Scalar>>("activation_potential", unit(variable.unit), impl::before_doc);
  }
  void particle(auto i) const {
    (*before)[i] = potential[i];
    first[i] = last[i] = -1.0;
  }
};

// At the end of each step.
struct ActivationTime : ParticleOperator<ActivationTime> {
  In<Scalar> potential{"potential"};
  std::unique_ptr<InOut<Scalar>> before;
  InOut<Scalar> first{"activation_time", unit("s"), impl::first_doc};
  InOut<Scalar> last{"last_activation", unit("s"), impl::last_doc};
  InOut<Scalar> number{"activations", unit("1"), impl::number_doc};
  InOut<Scalar> cycle{"mean_cycle_length", unit("s"), impl::cycle_doc};

  double threshold = 0;

  void set(const shoal_reaction_variable& variable) {
    potential.rename(variable.name);
    before = std::make_unique<InOut<Scalar>>("activation_potential", unit(variable.unit), impl::before_doc);
  }
  void particle(auto i) const {
    const double now = potential[i], then = (*before)[i];
    (*before)[i] = now;
    if (!(then < threshold && now >= threshold)) return;
    last[i] = time() + dt() * (threshold - then) / (now - then);
    if (number[i] == 0.0) first[i] = last[i];
    if (number[i] > 0.0) cycle[i] = (last[i] - first[i]) / number[i];
    number[i] += 1.0;
  }
};

}  // namespace shoal::diffusion
