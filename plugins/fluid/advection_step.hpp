// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What happens once in an advection step, apart from density and viscosity: its size, gravity, and the shift of
// particles in flows without a free surface.
#pragma once

#include <algorithm>

#include "shoal/interfaces/equation_of_state.h"
#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

#include "largest_speed.hpp"

namespace shoal::fluid {

// The step of the advection loop, for whose length neighbour lists and forces other than pressure are kept:
//   dt <= 0.25 h / max(|v|, U),   U the expected speed, so that a flow that starts from rest does so in small steps
// (Zhang, Rezavand, Hu 2020).
struct AdvectionStep : ParticleOperator<AdvectionStep> {
  In<Vector> velocity{"velocity"};

  double expected_speed = 0;  // m/s
  double cfl = 0.25;

  template <int D>
  double time_step_of_block(std::uint64_t begin, std::uint64_t end) const {
    return cfl * smoothing_length() / max(expected_speed, largest_speed<D>(velocity.data(), begin, end));
  }
};

// dv/dt = g
struct Gravity : ParticleOperator<Gravity> {
  Accumulate<Vector> acceleration{"acceleration"};

  Vector3 gravity{};  // m/s2

  void particle(auto i) const {
    for (int a = 0; a < i.dimensions; ++a) acceleration[i][a] += gravity[static_cast<std::size_t>(a)];
  }
};

// Transport velocity (Adami, Hu, Adams 2013; Zhang, Hu, Adams 2017) in the form of a shift once in an advection step:
//   dr_i = -C h^2 sum_j V_j grad W_ij,  |dr_i| <= 0.1 dx
// It keeps the particles evenly spread; without it they line up along streamlines and tear voids where the pressure is
// negative. C = 0.5 (measured: 0.2 leaves clumps at stagnation points of the Taylor-Green vortex).
struct TransportShift : PairOperator<TransportShift> {
  In<Scalar> volume{"volume"};
  Out<Vector> shift{"transport_shift", unit("m"), doc("Shift of the particle in this advection step."),
                    derived};

  double strength = 0.5;

  auto pair(const auto& p) const { return p.j(volume) * p.grad_W(); }
  void particle(auto i, auto sum) const {
    shift[i] = (-strength * smoothing_length() * smoothing_length()) * sum;
  }
};

// The walls' share; runs after TransportShift.
struct WallTransportShift : PairOperator<WallTransportShift> {
  static constexpr bool skips_lonely = true;

  In<Scalar> wall_volume{"volume", neighbours_only};
  InOut<Vector> shift{"transport_shift", unit("m"), doc("Shift of the particle in this advection step."),
                      derived};

  double strength = 0.5;

  auto pair(const auto& p) const { return p.j(wall_volume) * p.grad_W(); }
  void particle(auto i, auto sum) const {
    shift[i] += (-strength * smoothing_length() * smoothing_length()) * sum;
  }
};

struct ApplyShift : ParticleOperator<ApplyShift> {
  In<Vector> shift{"transport_shift", unit("m"), doc("Shift of the particle in this advection step."),
                   derived};
  InOut<Vector> position{"position"};

  void particle(auto i) const {
    const double length = norm(shift[i]), limit = 0.1 * spacing();
    position[i] += (length > limit ? limit / length : 1.0) * shift[i];
  }
};

// Before the first step: masses from the volumes, and densities from the initial pressure.
struct InitialState : ParticleOperator<InitialState> {
  In<Scalar> pressure{"pressure"};
  Out<Scalar> mass{"mass"};
  Out<Scalar> density{"density"};
  InOut<Scalar> volume{"volume"};

  Interface<shoal_equation_of_state> equation_of_state;

  void block(std::uint64_t begin, std::uint64_t end) const {
    const double rho0 = equation_of_state.api->reference_density(equation_of_state.self);
    equation_of_state.api->density(equation_of_state.self, end - begin, pressure.data() + begin,
                                   density.data() + begin);
    for (std::uint64_t i = begin; i < end; ++i) {
      mass.data()[i] = rho0 * volume.data()[i];
      volume.data()[i] = mass.data()[i] / density.data()[i];
    }
  }
};

}  // namespace shoal::fluid
