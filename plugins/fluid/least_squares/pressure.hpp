// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Pressure by artificial compressibility (Chorin 1967) within an advection step, on frozen particles:
//   dp/dt = -rho c^2 div v,   dv/dt = f - grad p / rho.
// The velocity is eliminated, which leaves a wave equation for the pressure alone,
//   d2p/dt2 = c^2 lap p - rho c^2 (div f - S),   S = tr(grad v . grad v),   dp/dt (0) = -rho c^2 (div v' + dt/2 S),
// so that an acoustic sub-step is one sum over neighbours of one number. S is the rate at which the divergence of a
// given set of velocities changes as the particles move on: with it the frozen geometry acts as the moving one would.
// Without S the pressure rises and falls by rho c^2 dt^2 S / 8 in each step, which does not converge with c ~ 1/dx: it
// was the leading error from 100^2 particles on.
//   leapfrog  (dp/dt)^(k+1/2) = (dp/dt)^(k-1/2) + dt_a d2p/dt2,   p^(k+1) = p^k + dt_a (dp/dt)^(k+1/2)
//   damping   c^2 lap (p + d dx/c dp/dt): bulk viscosity, which waves of grid size need when particles move
//   v^(n+1) = v' + dt f - grad P / rho,   P = integral of p + d dx/c dp/dt over the step
// Damping must act on the velocity too: waves longer than a step's way of sound live on in it alone. (Without it the
// lowest mode of a closed cavity decays three times slower than it should, and the flow's noise feeds it.)
// lap, not div grad: the difference, of fourth order, filters the pressure that a gradient does not see.
// Stable, for the damping is taken from the step before, where (c dt_a)^2 lambda + 2 d dx c dt_a lambda < 4, lambda the largest
// eigenvalue of the Laplacian: at d = 0.2 on evenly spread particles dt_a < 0.72 h / c, less where particles are pulled apart in
// one direction and the fit is stiff. lambda is taken for the stiffest particle from the bound of fit.hpp, times their ratio on
// a lattice (1.17 in 2D), so that acoustic steps follow the particles.
#pragma once

#include <algorithm>
#include <cmath>

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

#include "course.hpp"
#include "fit.hpp"
#include "motion.hpp"
#include "viscosity.hpp"

namespace shoal::fluid::least_squares {

inline constexpr const char *source_doc = "Source of the pressure's wave equation.",
                            *wave_doc = "Pressure with the damping of its waves, times c^2.",
                            *impulse_doc = "Time integral of the pressure over the advection step.",
                            *pressure_rate_doc = "Rate of change of the pressure.";

// Source and initial rate of the wave equation.
struct WaveSource : PairOperator<WaveSource> {
  static constexpr bool row_by_row = true;

  template <int D>
  using Kernel = Weight<D>;

  In<FitGradient> gradient{"fit_gradient", unit("1"), doc(gradient_doc), derived, own_only};
  In<Vector> velocity{"carried_velocity", unit("m/s"), doc(carried_doc), derived};
  In<Vector> force{"specific_force", unit("m/s2"), doc(force_doc), derived};
  In<Matrix> velocity_gradient{"velocity_gradient", unit("1/s"), doc(dv_doc), own_only};
  In<Scalar> pressure{"pressure", own_only};
  Out<Scalar> source{"pressure_source", unit("Pa/s2"), doc(source_doc), derived};
  Out<Scalar> rate{"pressure_rate", unit("Pa/s"), doc(pressure_rate_doc), derived};
  Out<Scalar> wave{"pressure_wave", unit("Pa m2/s2"), doc(wave_doc), derived};
  Out<Scalar> impulse{"pressure_impulse", unit("Pa s"), doc(impulse_doc), derived};

  CoursePointer course;
  double density = 0;  // kg/m3

  void begin() { course->first_acoustic = true; }
  auto pair(const auto& p) const {
    const auto g = fit_gradient(p, p.i(gradient));
    return sums(dot(p.j(velocity) - p.i(velocity), g), dot(p.j(force) - p.i(force), g));
  }
  void particle(auto i, double div_v, double div_f) const {
    const double c2 = course->sound_speed * course->sound_speed;
    const auto dv = velocity_gradient[i];
    const double s = trace(dv * dv);
    source[i] = -density * c2 * (div_f - s);
    rate[i] = -density * c2 * (div_v + 0.5 * dt() * s);
    wave[i] = c2 * pressure[i];
    impulse[i] = 0.0;
  }
};

// Kick of the pressure's rate.
struct WaveRate : PairOperator<WaveRate> {
  template <int D>
  using Kernel = Weight<D>;

  In<FitLaplacian> laplacian{"fit_laplacian", unit("1"), doc(laplacian_doc), derived, own_only};
  In<Scalar> wave{"pressure_wave", unit("Pa m2/s2"), doc(wave_doc), derived};
  In<Scalar> source{"pressure_source", unit("Pa/s2"), doc(source_doc), derived, own_only};
  InOut<Scalar> rate{"pressure_rate", unit("Pa/s"), doc(pressure_rate_doc), derived};

  CoursePointer course;
  double kick = 0;  // s

  void begin() {
    kick = course->first_acoustic ? 0.5 * dt() : dt();
    course->first_acoustic = false;
  }
  auto store(const auto& p) const { return fit_laplacian(p, p.i(laplacian)); }
  auto pair(const auto& p, const auto& weight) const { return weight * (p.j(wave) - p.i(wave)); }
  void particle(auto i, double sum) const { rate[i] += kick * (sum + source[i]); }
};

// Drift of the pressure.
struct WaveStep : ParticleOperator<WaveStep> {
  static constexpr double safety = 0.9;

  In<Scalar> rate{"pressure_rate", unit("Pa/s"), doc(pressure_rate_doc), derived};
  InOut<Scalar> pressure{"pressure"};
  InOut<Scalar> impulse{"pressure_impulse", unit("Pa s"), doc(impulse_doc), derived};
  Out<Scalar> wave{"pressure_wave", unit("Pa m2/s2"), doc(wave_doc), derived};

  CoursePointer course;
  double cfl = 0.6;
  double damping = 0.2;
  double eigenvalue_over_norm = 0;  // of the Laplacian on a lattice: the largest over laplacian_norm

  void particle(auto i) const {
    const double c = course->sound_speed, before = pressure[i], after = before + dt() * rate[i];
    pressure[i] = after;
    impulse[i] += 0.5 * dt() * (before + after) + damping * spacing() / c * (after - before);
    wave[i] = c * c * after + damping * c * spacing() * rate[i];
  }
  double time_step(double h) const {
    const double c = course->sound_speed, by_damping = damping * spacing();
    const double stiffness = eigenvalue_over_norm * course->laplacian_norm;
    const double stable = std::sqrt(by_damping * by_damping + 4.0 * safety / stiffness) - by_damping;
    return std::min(cfl * h, stable) / c;
  }
};

// Mean acceleration by pressure.
struct PressureForce : PairOperator<PressureForce> {
  static constexpr bool row_by_row = true;

  template <int D>
  using Kernel = Weight<D>;

  In<FitGradient> gradient{"fit_gradient", unit("1"), doc(gradient_doc), derived, own_only};
  In<Scalar> impulse{"pressure_impulse", unit("Pa s"), doc(impulse_doc), derived};
  Out<Vector> by_pressure{"pressure_acceleration", unit("m/s2"), doc("Acceleration by pressure.")};

  double density = 0;  // kg/m3

  auto pair(const auto& p) const { return (p.j(impulse) - p.i(impulse)) * fit_gradient(p, p.i(gradient)); }
  void particle(auto i, auto sum) const { by_pressure[i] = (-1.0 / (density * dt())) * sum; }
};

}  // namespace shoal::fluid::least_squares
