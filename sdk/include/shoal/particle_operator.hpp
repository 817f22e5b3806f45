// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators that look at one particle at a time:
//
//     struct Kick : shoal::ParticleOperator<Kick> {
//       In<Vector> acceleration{"acceleration"};
//       InOut<Vector> velocity{"velocity"};
//       void particle(auto i) const { velocity[i] += dt() * acceleration[i]; }
//     };
//
// Optional members: begin() and end() [main thread, before and after the particles], bound() [after the arrays have
// moved], time_step(h), time_step_of(i) or time_step_of_block<D>(begin, end) [largest stable step of the loop],
// save(stream) and load(stream);
// exchange(Exchange&) [before neighbours are renewed: particles leave and join], fill(begin, end) [what joined].
// An operator that works on whole blocks defines block(begin, end) instead of particle(i).
#pragma once

#include "shoal/operator.hpp"

namespace shoal {

template <class Derived>
class ParticleOperator : public OperatorBase {
 public:
  static constexpr bool pairs = false;

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const auto& self = static_cast<const Derived&>(*this);
    if constexpr (requires { self.block(chunk.begin, chunk.end); })
      self.block(chunk.begin, chunk.end);
    else if constexpr (requires { self.particle(Particle<D>{}); })
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) self.particle(Particle<D>{i, chunk.partial});
  }

 protected:
  ParticleOperator() : OperatorBase(false) {}
};

}  // namespace shoal
