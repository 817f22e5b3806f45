// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Position-based Verlet of one acoustic step (Zhang, Rezavand, Hu 2021, section 3.2):
//   rho^(n+1/2) = rho^n + dt/2 (d rho/dt)^n,   r^(n+1/2) = r^n + dt/2 v^n          AcousticPredictor
//   v^(n+1)     = v^n + dt (dv/dt)^(n+1/2)                                         PressureForce, Kick
//   r^(n+1)     = r^(n+1/2) + dt/2 v^(n+1)                                         Kick
//   rho^(n+1)   = rho^(n+1/2) + dt/2 (d rho/dt)^(n+1)                              VelocityDivergence, DensityCorrector
// with the pressure
//   p = p_eos(rho^(n+1/2)) + zeta (-rho div v)^n,    zeta = A c h
// whose second part is a bulk viscosity: it damps sound, whatever its wavelength, at the rate A c h k^2 / 2, and does
// nothing to an incompressible flow (compare the acoustic damper of Sun et al. 2023).
//
// Stability. The shortest sound waves that pairs resolve have a wave number kappa / h, kappa^2 = 2.25 where walls reflect
// them (measured on hydrostatic_2d; 1.3 in the interior of a lattice with h = 1.3 dx, where steps could be longer but
// drops lose more energy by them). Per step their phase is C kappa, C = dt c / h, and their damping, one step late, A C kappa^2:
//   C^2 kappa^2 + 2 A C kappa^2 < 4,    C < sqrt(A^2 + 4 / kappa^2) - A
// What dissipates jumps of the pressure, B times the Riemann solver's, shrinks a checkerboard at the rate 3 B c / h:
//   C < 2 / (3 B)
#pragma once

#include <algorithm>
#include <cmath>

#include "shoal/interfaces/equation_of_state.h"
#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

#include "largest_speed.hpp"

namespace shoal::fluid {

using EquationOfState = Interface<shoal_equation_of_state>;

// The largest C = dt c / h for a damping A and dissipation B of pressure jumps (0: none).
inline double longest_acoustic_step(double damping, double dissipation) {
  constexpr double kappa_squared = 2.25;
  const double sound = std::sqrt(damping * damping + 4.0 / kappa_squared) - damping;
  return std::min(sound, 2.0 / std::max(1e-3, 3.0 * dissipation));
}

// Half a step of density and position; pressure and volume from the new density.
struct AcousticPredictor : ParticleOperator<AcousticPredictor> {
  In<Vector> velocity{"velocity"};
  In<Scalar> mass{"mass"};
  In<Scalar> compression{"compression_rate", unit("kg/m3/s"),
                         doc("Rate of the density by convergence of the velocity.")};
  In<Scalar> diffusion{"density_diffusion", unit("kg/m3/s"),
                       doc("Rate of the density by dissipation of pressure jumps.")};
  InOut<Vector> position{"position"};
  InOut<Scalar> density{"density"};
  Out<Scalar> pressure{"pressure"};
  Out<Scalar> volume{"volume"};

  EquationOfState equation_of_state;
  double sound_speed = 0;  // m/s
  double cfl = 0.9;        // over h / (c + |v|)
  double damping = 0;      // A

  void block(std::uint64_t begin, std::uint64_t end) const {
    const double half = 0.5 * dt();
    const double *__restrict rate = compression.data(), *__restrict diffused = diffusion.data(),
                 *__restrict m = mass.data(), *__restrict v = velocity.data();
    double *__restrict rho = density.data(), *__restrict vol = volume.data(), *__restrict x = position.data(),
                       *__restrict p = pressure.data();
    for (std::uint64_t i = begin; i < end; ++i) {
      rho[i] += half * (rate[i] + diffused[i]);
      vol[i] = m[i] / rho[i];
    }
    const auto d = static_cast<std::uint64_t>(dimensions());
    for (std::uint64_t k = begin * d; k < end * d; ++k) x[k] += half * v[k];
    equation_of_state.api->pressure(equation_of_state.self, end - begin, rho + begin, p + begin);
    const double zeta = damping * sound_speed * smoothing_length();
    for (std::uint64_t i = begin; i < end; ++i) p[i] += zeta * rate[i];
  }
  template <int D>
  double time_step_of_block(std::uint64_t begin, std::uint64_t end) const {
    return cfl * smoothing_length() / (sound_speed + largest_speed<D>(velocity.data(), begin, end));
  }
};

// A full step of velocity and half a step of position.
struct Kick : ParticleOperator<Kick> {
  In<Vector> acceleration{"acceleration"};
  In<Vector> pressure_acceleration{"pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure.")};
  InOut<Vector> velocity{"velocity"};
  InOut<Vector> position{"position"};
  Out<Vector> last_acceleration{"last_pressure_acceleration", unit("m/s2"),
                                doc("Acceleration by pressure in the last acoustic step.")};

  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto d = static_cast<std::uint64_t>(dimensions());
    const double step = dt(), half = 0.5 * step;
    const double* __restrict a = acceleration.data(), * __restrict by_pressure = pressure_acceleration.data();
    double *__restrict v = velocity.data(), *__restrict x = position.data(),
                       *__restrict last = last_acceleration.data();
    for (std::uint64_t k = begin * d; k < end * d; ++k) {
      last[k] = by_pressure[k];
      v[k] += step * (a[k] + by_pressure[k]);
      x[k] += half * v[k];
    }
  }
};

// The second half of the step of density.
struct DensityCorrector : ParticleOperator<DensityCorrector> {
  In<Scalar> compression{"compression_rate", unit("kg/m3/s"),
                         doc("Rate of the density by convergence of the velocity.")};
  In<Scalar> diffusion{"density_diffusion", unit("kg/m3/s"),
                       doc("Rate of the density by dissipation of pressure jumps.")};
  InOut<Scalar> density{"density"};

  void particle(auto i) const { density[i] += 0.5 * dt() * (compression[i] + diffusion[i]); }
};

}  // namespace shoal::fluid
