// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The mean viscous acceleration of an advection step. With all other forces frozen in F,
//   dw/dt = nu lap w + F,   w(0) = v',   f = [w(dt) - v'] / dt - F,
// by super-time-stepping: s stages of a second-order Runge-Kutta-Legendre method (Meyer, Balsara, Aslam 2014,
// doi:10.1016/j.jcp.2013.08.021), stable for nu lambda dt <= (s^2 + s - 2) / 2, lambda the largest eigenvalue of the
// Laplacian. The number of stages follows from dt, so that viscosity does not limit it.
//
// The Laplacian is taken directly, not as a divergence of gradients, whose wide stencil damps too little. Its leading
// error on evenly spread particles is smooth, beta_i lap lap v with beta_i = <x^4>/24 of the weights (on average over
// directions sum_j l_ij r^4 / 64 in 2D, / 120 in 3D), and is taken off once:
//   f' = f - beta_i lap f.
// That leaves the decay of the Taylor-Green vortex at 50^2 particles with a fifth of the error.
#pragma once

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

#include "course.hpp"
#include "fit.hpp"
#include "motion.hpp"

namespace shoal::fluid::least_squares {

inline constexpr const char *rate_doc = "Rate of change of the velocity in a viscous stage.",
                            *force_doc = "Acceleration by all but pressure.",
                            *stage_doc = "Velocity in the stages of the viscous step.",
                            *viscous_doc = "Mean viscous acceleration of the advection step.";

struct ViscousStart : ParticleOperator<ViscousStart> {
  In<Vector> carried{"carried_velocity", unit("m/s"), doc(carried_doc), derived};
  Out<Vector> stage_velocity{"viscous_velocity", unit("m/s"), doc(stage_doc), derived};

  void particle(auto i) const { stage_velocity[i] = carried[i]; }
};

// nu lap w + F
struct ViscousRate : PairOperator<ViscousRate> {
  template <int D>
  using Kernel = Weight<D>;

  In<FitLaplacian> laplacian{"fit_laplacian", unit("1"), doc(laplacian_doc), derived, own_only};
  In<Vector> stage_velocity{"viscous_velocity", unit("m/s"), doc(stage_doc), derived};
  In<Vector> acceleration{"acceleration", own_only};
  In<Vector> pressure_gradient{"pressure_gradient", unit("Pa/m"), doc(dp_doc), own_only};
  Out<Vector> rate{"viscous_rate", unit("m/s2"), doc(rate_doc), derived};

  double viscosity = 0;  // kinematic, m2/s
  double density = 0;    // kg/m3

  auto store(const auto& p) const { return fit_laplacian(p, p.i(laplacian)); }
  auto pair(const auto& p, const auto& weight) const {
    return weight * (p.j(stage_velocity) - p.i(stage_velocity));
  }
  void particle(auto i, auto sum) const {
    rate[i] = viscosity * sum + acceleration[i] - (1.0 / density) * pressure_gradient[i];
  }
};

// Coefficients of stage j of s.
struct LegendreStage {
  double mu, nu, mu_rate, gamma_rate;

  // Time of the velocities after stage j, in steps.
  static double time(int j, int s) {
    return j == 0 ? 0.0 : j == 1 ? 4.0 / (3.0 * (s * s + s - 2.0)) : (j * j + j - 2.0) / (s * s + s - 2.0);
  }
  static double b(int j) { return j < 2 ? 1.0 / 3.0 : (j * j + j - 2.0) / (2.0 * j * (j + 1.0)); }
  static LegendreStage of(int j, int s) {
    const double w1 = 4.0 / (s * s + s - 2.0);
    if (j == 1) return {1.0, 0.0, b(1) * w1, 0.0};
    const double mu = (2.0 * j - 1.0) / j * b(j) / b(j - 1);
    return {mu, -(j - 1.0) / j * b(j) / b(j - 2), mu * w1, -(1.0 - b(j - 1)) * mu * w1};
  }
};

// One stage; after the last the mean viscous acceleration.
struct ViscousStage : ParticleOperator<ViscousStage> {
  In<Vector> carried{"carried_velocity", unit("m/s"), doc(carried_doc), derived};
  In<Vector> rate{"viscous_rate", unit("m/s2"), doc(rate_doc), derived};
  In<Vector> acceleration{"acceleration"};
  In<Vector> pressure_gradient{"pressure_gradient", unit("Pa/m"), doc(dp_doc)};
  InOut<Vector> stage_velocity{"viscous_velocity", unit("m/s"), doc(stage_doc), derived};
  InOut<Vector> previous{"viscous_velocity_before", unit("m/s"), doc("Of the stage before."), derived};
  InOut<Vector> first_rate{"viscous_first_rate", unit("m/s2"), doc("Rate in the first stage."), derived};
  Out<Vector> viscous{"viscous_acceleration", unit("m/s2"), doc(viscous_doc), derived};

  CoursePointer course;
  double density = 0;  // kg/m3
  LegendreStage stage{};

  void begin() { stage = LegendreStage::of(++course->viscous_stage, course->viscous_stages); }
  void particle(auto i) const {
    const auto w0 = carried[i], w = stage_velocity[i];
    const double whole = course->dt;
    if (course->viscous_stage == 1) {
      first_rate[i] = rate[i];
      stage_velocity[i] = w + stage.mu_rate * whole * rate[i];
    } else {
      stage_velocity[i] = stage.mu * w + stage.nu * previous[i] + (1.0 - stage.mu - stage.nu) * w0 +
                          whole * (stage.mu_rate * rate[i] + stage.gamma_rate * first_rate[i]);
    }
    previous[i] = w;
    if (course->viscous_stage == course->viscous_stages)
      viscous[i] =
          (1.0 / whole) * (stage_velocity[i] - w0) - acceleration[i] + (1.0 / density) * pressure_gradient[i];
  }
  // The loop of stages: as many sub-steps as stages.
  double time_step(double) const { return course->dt / course->viscous_stages; }
};

// The viscous force without the leading error of the Laplacian, and with the forces of `acceleration`.
struct ViscousForce : PairOperator<ViscousForce> {
  static constexpr bool row_by_row = true;

  template <int D>
  using Kernel = Weight<D>;

  In<FitLaplacian> laplacian{"fit_laplacian", unit("1"), doc(laplacian_doc), derived, own_only};
  In<Vector> viscous{"viscous_acceleration", unit("m/s2"), doc(viscous_doc), derived};
  In<Vector> acceleration{"acceleration", own_only};
  Out<Vector> force{"specific_force", unit("m/s2"), doc(force_doc), derived};

  auto pair(const auto& p) const {
    const auto weight = fit_laplacian(p, p.i(laplacian));
    const auto r2 = squared_norm(p.r_ij());
    return sums(weight * (p.j(viscous) - p.i(viscous)), weight * r2 * r2);
  }
  void particle(auto i, auto laplacian_of_viscous, double fourth_moment) const {
    const double bias = fourth_moment / (i.dimensions == 2 ? 64.0 : 120.0);
    force[i] = acceleration[i] + viscous[i] - bias * laplacian_of_viscous;
  }
};

// Without viscosity.
struct InviscidForce : ParticleOperator<InviscidForce> {
  In<Vector> acceleration{"acceleration"};
  Out<Vector> force{"specific_force", unit("m/s2"), doc(force_doc), derived};

  void particle(auto i) const { force[i] = acceleration[i]; }
};

}  // namespace shoal::fluid::least_squares
