// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The motion of particles in an advection step of length dt, in which they follow the flow and are shifted by dr_i to
// stay evenly spread (arbitrary Lagrangian-Eulerian). All derivatives are taken once, at the midpoint:
//   x^(n+1/2) = x^n + dt/2 v^n + dt^2/8 a^(n-1/2) + dr/2                                        Departure
//   v^(n+1/2) ~ v^n + dt/2 a^(n-1/2) + dr/2 . grad v^(n-1/2),   p ~ p^n + dr/2 . grad p^(n-1/2)
//   v' = v^n + dr . grad v^(n+1/2),   p' = p^n + dr . grad p^(n+1/2)                            Carry
//   v^(n+1) = v' + dt a^(n+1/2),   a = g + viscous force - grad p / rho
//   x^(n+1) = x^(n+1/2) + dt/2 v^(n+1) - dt^2/8 a^(n-1/2) + dr/2                                Arrival
// Carrying the fields along the shift with the gradient at its middle is exact to second order, so the shift costs no
// second derivatives and no second fit. Without it the shift is the leading error (Negi, Ramachandran 2022).
#pragma once

#include <algorithm>
#include <cmath>

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

#include "course.hpp"
#include "fit.hpp"

namespace shoal::fluid::least_squares {

inline constexpr const char *total_doc = "Acceleration by all forces in the last advection step.",
                            *dv_doc = "Gradient of the velocity at the midpoint, dv_a/dx_b.",
                            *dp_doc = "Gradient of the pressure at the midpoint.",
                            *v_mid_doc = "Velocity at the midpoint of the advection step.",
                            *p_mid_doc = "Pressure at the midpoint of the advection step.",
                            *carried_doc = "Velocity carried along the shift, before the forces.";

// The advection step: dt <= cfl h / max(|v|, least speed), dt <= d h^2 / nu. The viscous step is stable beyond that, but what
// extrapolates a^(n-1/2) is not (measured: vortices that decay hold with d = 1 and fail with 1.5).
struct Departure : ParticleOperator<Departure> {
  In<Vector> total{"total_acceleration", unit("m/s2"), doc(total_doc)};
  In<Vector> shift{"shift", unit("m"), doc(shift_doc)};
  In<Matrix> velocity_gradient{"velocity_gradient", unit("1/s"), doc(dv_doc)};
  In<Vector> pressure_gradient{"pressure_gradient", unit("Pa/m"), doc(dp_doc)};
  In<Vector> velocity{"velocity"};
  In<Scalar> pressure{"pressure"};
  InOut<Vector> position{"position"};
  Out<Vector> velocity_mid{"velocity_mid", unit("m/s"), doc(v_mid_doc), derived};
  Out<Scalar> pressure_mid{"pressure_mid", unit("Pa"), doc(p_mid_doc), derived};
  Maximum fastest{};

  CoursePointer course;
  double mach = 0.05;           // of the largest speed
  double viscosity = 0;         // kinematic, m2/s
  double stiffness = 0;         // of the Laplacian: largest eigenvalue times dx^2
  double cfl = 0.25;            // of the advection
  double viscous_number = 1.0;  // d above
  double least_speed = 0;       // m/s, below which steps grow no further

  void begin() {
    course->dt = dt();
    course->viscous_stage = 0;
    course->viscous_stages = stages(viscosity * stiffness / (spacing() * spacing()) * dt());
  }
  void particle(auto i) const {
    const auto v = velocity[i];
    const auto half_shift = 0.5 * shift[i];
    fastest.update(i, norm(v));
    position[i] += 0.5 * dt() * v + 0.125 * dt() * dt() * total[i] + half_shift;
    velocity_mid[i] = v + 0.5 * dt() * total[i] + velocity_gradient[i] * half_shift;
    pressure_mid[i] = pressure[i] + dot(pressure_gradient[i], half_shift);
  }
  void end() { course->sound_speed = std::max(fastest.result(), least_speed) / mach; }

  double time_step_of(auto i) const {
    const double h = smoothing_length();
    const double of_speed = cfl * h / std::max(norm(velocity[i]), least_speed);
    return viscosity > 0.0 ? std::min(of_speed, viscous_number * h * h / viscosity) : of_speed;
  }

  // Stages of a Runge-Kutta-Legendre step that is stable for `number`, the largest eigenvalue times dt: odd, for those
  // damp all modes.
  static int stages(double number) {
    int s = 3;
    while (0.5 * (s * s + s - 2) < number) s += 2;
    return s;
  }
};

// Gradients at the midpoint, and the fields carried along the shift.
struct Carry : PairOperator<Carry> {
  static constexpr bool row_by_row = true;

  template <int D>
  using Kernel = Weight<D>;

  In<FitGradient> gradient{"fit_gradient", unit("1"), doc(gradient_doc), derived, own_only};
  In<Vector> velocity_mid{"velocity_mid", unit("m/s"), doc(v_mid_doc), derived};
  In<Scalar> pressure_mid{"pressure_mid", unit("Pa"), doc(p_mid_doc), derived};
  In<Vector> shift{"shift", unit("m"), doc(shift_doc), own_only};
  In<Vector> velocity{"velocity", own_only};
  InOut<Scalar> pressure{"pressure"};
  Out<Vector> carried{"carried_velocity", unit("m/s"), doc(carried_doc), derived};
  Out<Matrix> velocity_gradient{"velocity_gradient", unit("1/s"), doc(dv_doc)};
  Out<Vector> pressure_gradient{"pressure_gradient", unit("Pa/m"), doc(dp_doc)};

  auto pair(const auto& p) const {
    const auto g = fit_gradient(p, p.i(gradient));
    return sums(outer(p.j(velocity_mid) - p.i(velocity_mid), g), (p.j(pressure_mid) - p.i(pressure_mid)) * g);
  }
  void particle(auto i, auto dv, auto dp) const {
    carried[i] = velocity[i] + dv * shift[i];
    pressure[i] += dot(dp, shift[i]);
    velocity_gradient[i] = dv;
    pressure_gradient[i] = dp;
  }
};

struct Arrival : ParticleOperator<Arrival> {
  In<Vector> force{"specific_force", unit("m/s2"), doc("Acceleration by all but pressure."), derived};
  In<Vector> by_pressure{"pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure.")};
  In<Vector> next_shift{"next_shift", unit("m"), doc(shift_doc), derived};
  InOut<Vector> shift{"shift", unit("m"), doc(shift_doc)};
  InOut<Vector> total{"total_acceleration", unit("m/s2"), doc(total_doc)};
  In<Vector> carried{"carried_velocity", unit("m/s"), doc(carried_doc), derived};
  Out<Vector> velocity{"velocity"};
  InOut<Vector> position{"position"};

  void particle(auto i) const {
    const auto a = force[i] + by_pressure[i];
    velocity[i] = carried[i] + dt() * a;
    position[i] += 0.5 * dt() * velocity[i] - 0.125 * dt() * dt() * total[i] + 0.5 * shift[i];
    total[i] = a;
    shift[i] = next_shift[i];
  }
};

}  // namespace shoal::fluid::least_squares
