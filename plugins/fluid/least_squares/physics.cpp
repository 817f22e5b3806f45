// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "physics.hpp"

#include <cmath>
#include <cstdio>

#include "shoal/interfaces/equation_of_state.h"

#include "../advection_step.hpp"
#include "course.hpp"
#include "fit.hpp"
#include "initial.hpp"
#include "motion.hpp"
#include "pressure.hpp"
#include "stiffness.hpp"
#include "viscosity.hpp"

namespace shoal::fluid {
namespace {

using namespace least_squares;

constexpr At at_drift{"advection", "drift"};
constexpr At at_flow{"advection", "flow"};
constexpr At at_fit{"midpoint", "fit"};
constexpr At at_forces{"midpoint", "forces"};
constexpr At at_viscous{"midpoint", "viscous"};
constexpr At at_stage{"viscous", "stage"};
constexpr At at_source{"midpoint", "source"};
constexpr At at_acoustic{"midpoint", "acoustic"};
constexpr At at_wave{"acoustic", "wave"};
constexpr At at_arrival{"midpoint", "arrival"};

// What the operators of one fluid body share.
struct FluidBody {
  const Builder& b;
  const LeastSquares& physics;
  BodyIndex body;
  double density;    // kg/m3
  double viscosity;  // kinematic, m2/s
  CoursePointer course = std::make_shared<Course>();

  Target target() const {
    Target target = b.target(body);
    target.smoothing_kernel = SmoothingKernel::wendland_c2;
    target.cutoff = cutoff_radius(target.smoothing_kernel, target.smoothing_length);
    return target;
  }

  void attach_motion() const {
    const double h_over_dx = target().smoothing_length / target().spacing;
    b.attach<Departure>("fluid.departure", at_drift, target(), [&](auto& op) {
      op.course = course;
      op.expected_speed = physics.max_speed;
      op.mach = physics.mach;
      op.viscosity = viscosity;
      op.stiffness = laplacian_stiffness(b.dimensions(), h_over_dx);
      op.cfl = physics.advection_cfl;
      op.viscous_number = physics.viscous_number;
    });
    b.attach<Fit>("fluid.fit", at_fit, target(),
                  [&](auto& op) { op.shift_strength = physics.shift_strength; });
    b.attach<Carry>("fluid.carry", at_fit, target());
  }

  void attach_forces() const {
    b.own_field(body, "acceleration", at_forces);
    const Vector3 g = b.gravity();
    if (g != Vector3{})
      b.attach<Gravity>("fluid.gravity", at_forces, target(), [&](auto& op) { op.gravity = g; });
    if (viscosity == 0.0) {
      b.attach<InviscidForce>("fluid.inviscid_force", at_source, target());
      return;
    }
    b.attach<ViscousStart>("fluid.viscous_start", at_forces, target());
    b.attach<ViscousRate>("fluid.viscous_rate", at_stage, target(), [&](auto& op) {
      op.viscosity = viscosity;
      op.density = density;
    });
    b.attach<ViscousStage>("fluid.viscous_stage", at_stage, target(), [&](auto& op) {
      op.course = course;
      op.density = density;
    });
    b.attach<least_squares::ViscousForce>("fluid.viscous_force", at_source, target());
  }

  void attach_pressure() const {
    b.attach<WaveSource>("fluid.wave_source", at_source, target(), [&](auto& op) {
      op.course = course;
      op.density = density;
    });
    b.attach<WaveRate>("fluid.wave_rate", at_wave, target(), [&](auto& op) { op.course = course; });
    b.attach<WaveStep>("fluid.wave_step", at_wave, target(), [&](auto& op) {
      op.course = course;
      op.cfl = physics.acoustic_cfl;
      op.damping = physics.damping;
    });
    b.attach<least_squares::PressureForce>("fluid.pressure_force", at_arrival, target(),
                                           [&](auto& op) { op.density = density; });
    b.attach<Arrival>("fluid.arrival", at_arrival, target());
  }
};

}  // namespace

void LeastSquares::build(const Builder& b) {
  b.loop("advection", {"drift", "flow"});
  b.loop("midpoint", at_flow, {"fit", "forces", "viscous", "source", "acoustic", "arrival"});
  b.loop("viscous", at_viscous, {"stage"});
  b.loop("acoustic", at_acoustic, {"wave"});
  b.renew_neighbours_in("midpoint");

  for (const BodyIndex body : bodies.value()) {
    const auto eos = b.material_interface<shoal_equation_of_state>(body, SHOAL_EQUATION_OF_STATE,
                                                                   SHOAL_EQUATION_OF_STATE_REVISION);
    if (!eos)
      throw CaseError(std::string("body '") + b.body(body).name +
                      "' needs a material with a density and a viscosity, e.g. material: {fluid.liquid: "
                      "{density: 1000, viscosity: 1e-3}}");
    const double density = eos.api->reference_density(eos.self);
    const FluidBody fluid{b, *this, body, density, eos.api->viscosity(eos.self) / density};
    b.body_moves(body);
    b.attach<InitialMass>("fluid.initial_mass", {SHOAL_INITIAL, "state"}, fluid.target(),
                          [&](auto& op) { op.reference_density = density; });
    fluid.attach_motion();
    fluid.attach_forces();
    fluid.attach_pressure();
  }
}

}  // namespace shoal::fluid
