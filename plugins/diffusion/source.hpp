// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// C dc/dt += q(x, y, z, t), in W/m3 of heat, or the unit of the field per second. The expression is evaluated in each
// stage, at the time of the stage: some 50 ns a particle.
#pragma once

#include <memory>
#include <vector>

#include "integrator.hpp"
#include "shoal/particle_operator.hpp"
#include "species.hpp"

namespace shoal::diffusion {

struct Source : ParticleOperator<Source> {
  In<Vector> position{"position"};
  Accumulate<Scalar> rate{"rate", derived};

  Expression density;   // q
  double capacity = 1;  // J/(m3 K), or 1
  std::shared_ptr<const Stages> stages;
  Names names;

  void set(const std::string& field) { rate.rename(names.keep(rate_of(field))); }
  void begin() { stage_time_ = stages->time_of(step()); }
  void block(std::uint64_t begin, std::uint64_t end) const {
    std::vector<double> q(end - begin);
    const auto d = static_cast<std::uint64_t>(dimensions());
    density.evaluate(dimensions(), end - begin, position.data() + begin * d, stage_time_, q.data());
    for (std::uint64_t i = begin; i < end; ++i) rate.data()[i] += q[i - begin] / capacity;
  }

 private:
  double stage_time_ = 0;
};

}  // namespace shoal::diffusion
