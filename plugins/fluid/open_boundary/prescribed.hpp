// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What takes the place of the equations of motion in the zone of an open boundary. Stages of fluid.wcsph:
//   advection  zone_shift    no shift of particles                                               ZoneShift
//              zone_density  no re-initialisation of density, for which supports end too early   ZoneDensity
//   acoustic   zone_state    pressure and density, just before the force of pressure
//              zone_motion   velocity and place, just after Kick
// Extrapolation from the fluid's particles j to a particle i of the zone:
//   p_i = sum_j V_j W_ij [p_j - rho0 a_j.(r_i - r_j)] / sum_j V_j W_ij,   v_i = sum_j V_j W_ij v_j / sum_j V_j W_ij,
// a_j being the acceleration by pressure in the last step, whose gradient is exact for hydrostatic and for linear pressures.
// A particle of the zone that has no neighbour in the fluid is none of the fluid's either: it keeps what it had.
#pragma once

#include "../acoustic_step.hpp"
#include "zone.hpp"

namespace shoal::fluid {

inline constexpr FieldOption if_there_is_one{SHOAL_OPTIONAL, 0};

struct ZoneShift : ZoneOperator<ZoneShift> {
  InOut<Vector> shift{"transport_shift", unit("m"), doc("Shift of the particle in this advection step."),
                      derived, if_there_is_one};
  void member(auto i) const {
    if (shift.data() != nullptr) shift[i] = 0.0 * shift[i];
  }
};

// Density and volume that belong to a pressure.
inline void set_state(const EquationOfState& equation_of_state, double pressure, double mass, double& density,
                      double& volume) {
  equation_of_state.api->density(equation_of_state.self, 1, &pressure, &density);
  volume = mass / density;
}

struct ZoneDensity : ZoneOperator<ZoneDensity> {
  In<Scalar> pressure{"pressure"};
  In<Scalar> mass{"mass"};
  InOut<Scalar> density{"density"};
  InOut<Scalar> volume{"volume"};

  EquationOfState equation_of_state;

  void member(auto i) const { set_state(equation_of_state, pressure[i], mass[i], density[i], volume[i]); }
};

// Sums over the neighbours of a zone's particle that are fluid. To be attached with the body itself as neighbour.
template <class Derived>
struct Extrapolation : ZoneOperator<Derived> {
  In<Vector> position{"position", also_of_neighbours};
  In<Scalar> volume_of{"volume", also_of_neighbours};

  // term(j, V_j W_ij) for each of them; `n_owned` particles and their images stand in one array.
  template <int D, class Term>
  void for_each_fluid(Particle<D> i, const Term& term) const {
    const shoal_neighbours& list = this->neighbours(0);
    const std::uint32_t* row = list.indices + list.offsets[i.index];
    with_kernel<D>(this->target().smoothing_kernel, this->smoothing_length(), [&](const auto& kernel) {
      for (std::uint32_t k = 0; k < list.counts[i.index]; ++k) {
        const Particle<D> j{row[k], nullptr};
        if (this->open_boundary[j] != 0) continue;
        const double w = volume_of[j] * kernel.w(norm(position[i] - position[j]));
        if (w > 0.0) term(j, w);
      }
    });
  }
};

// Serial, for it reads of neighbours what it writes: but never of the particles that it writes.
struct ZonePressure : Extrapolation<ZonePressure> {
  In<Vector> acceleration{"last_pressure_acceleration", unit("m/s2"),
                          doc("Acceleration by pressure in the last acoustic step."), also_of_neighbours};
  In<Scalar> mass{"mass"};
  InOut<Scalar> pressure{"pressure", also_of_neighbours};
  InOut<Scalar> density{"density"};
  InOut<Scalar> volume{"volume"};

  EquationOfState equation_of_state;

  template <int D>
  void member(Particle<D> i) const {
    const double rho0 = equation_of_state.api->reference_density(equation_of_state.self);
    double sum = 0, weight = 0;
    for_each_fluid(i, [&](Particle<D> j, double w) {
      weight += w;
      sum += w * (pressure[j] - rho0 * dot(acceleration[j], position[i] - position[j]));
    });
    if (weight > 0.0) pressure[i] = sum / weight;
    set_state(equation_of_state, pressure[i], mass[i], density[i], volume[i]);
  }
};

}  // namespace shoal::fluid
