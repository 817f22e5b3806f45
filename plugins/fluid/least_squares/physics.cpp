// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "physics.hpp"

#include <cmath>
#include <cstdio>

#include "shoal/interfaces/equation_of_state.h"

#include "../advection_step.hpp"
#include "../kinematics.hpp"
#include "../liquid.hpp"
#include "../velocity_filter.hpp"
#include "clearance.hpp"
#include "course.hpp"
#include "fit.hpp"
#include "initial.hpp"
#include "motion.hpp"
#include "pressure.hpp"
#include "stiffness.hpp"
#include "viscosity.hpp"
#include "walls.hpp"

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

struct WallBody {
  BodyIndex body;
  bool slips;
};

// What the operators of one fluid body share.
struct FluidBody {
  const Builder& b;
  const LeastSquares& physics;
  BodyIndex body;
  double density;    // kg/m3
  double viscosity;  // kinematic, m2/s
  std::vector<WallBody> walls{};
  CoursePointer course = std::make_shared<Course>();

  // Nothing drives the flow, so that steps may grow as it slows down. A driven one starts from rest in small steps.
  bool decaying() const { return walls.empty() && b.gravity() == Vector3{}; }

  double h_over_dx() const { return alone().smoothing_length / alone().spacing; }
  Target alone() const { return fitted(b.target(body)); }
  // With all particles that the fits look at.
  Target target() const {
    std::vector<BodyIndex> neighbours{body};
    for (const WallBody& wall : walls) neighbours.push_back(wall.body);
    return fitted(b.target(body, neighbours));
  }
  Target walls_alone() const {
    std::vector<BodyIndex> neighbours;
    for (const WallBody& wall : walls) neighbours.push_back(wall.body);
    return fitted(b.target(body, neighbours));
  }
  static Target fitted(Target target) {
    target.smoothing_kernel = SmoothingKernel::wendland_c2;
    target.cutoff = cutoff_radius(target.smoothing_kernel, target.smoothing_length);
    return target;
  }

  // The same operator on each wall. Its fits look at the fluid around the surface, up to 2h from the wall's particle.
  template <class Op>
  void attach_at_walls(const char* name, At at) const {
    for (const WallBody& wall : walls) attach_at_wall<Op>(name, at, wall);
  }
  template <class Op>
  void attach_at_wall(const char* name, At at, const WallBody& wall) const {
    Target target = b.target(wall.body, {body});
    target.smoothing_length = b.target(body).smoothing_length;
    target = fitted(target);
    target.cutoff *= 2.0;
    b.attach<Op>(name, at, target, [&](auto& op) {
      if constexpr (requires { op.course; }) op.course = course;
      if constexpr (requires { op.density; }) op.density = density;
    });
  }
  template <class Of>
  void attach_wall_velocity(const char* name, At at) const {
    for (const WallBody& wall : walls)
      wall.slips ? attach_at_wall<FreeSlipWallVelocity<Of>>(name, at, wall)
                 : attach_at_wall<WallVelocity<Of>>(name, at, wall);
  }

  void attach_motion() const {
    b.attach<Departure>("fluid.departure", at_drift, alone(), [&](auto& op) {
      op.course = course;
      op.least_speed = decaying() ? 0.1 * physics.max_speed : physics.max_speed;
      op.mach = physics.mach;
      op.viscosity = viscosity;
      op.stiffness = laplacian_stiffness(b.dimensions(), h_over_dx());
      op.cfl = physics.advection_cfl;
      op.viscous_number = physics.viscous_number;
    });
    b.attach<Fit>("fluid.fit", at_fit, target(), [&](auto& op) {
      op.shift_strength = physics.shift_strength;
      op.course = course;
    });
    if (!walls.empty()) b.attach<Clearance>("fluid.clearance", at_fit, walls_alone());
    attach_at_walls<WallSurface>("fluid.wall_surface", at_fit);
    attach_at_walls<WallFit>("fluid.wall_fit", at_fit);
    attach_wall_velocity<MidVelocity>("fluid.wall_velocity_mid", at_fit);
    attach_at_walls<WallPressure<MidPressure>>("fluid.wall_pressure_mid", at_fit);
    b.attach<Carry>("fluid.carry", at_fit, target());
    attach_wall_velocity<CarriedVelocity>("fluid.wall_carried_velocity", at_fit);
  }

  void attach_forces() const {
    b.own_field(body, "acceleration", at_forces);
    const Vector3 g = b.gravity();
    if (g != Vector3{})
      b.attach<Gravity>("fluid.gravity", at_forces, alone(), [&](auto& op) { op.gravity = g; });
    if (viscosity == 0.0) {
      b.attach<InviscidForce>("fluid.inviscid_force", at_source, alone());
      return;
    }
    b.attach<ViscousStart>("fluid.viscous_start", at_forces, alone());
    attach_wall_velocity<StageVelocity>("fluid.wall_viscous_velocity", at_stage);
    b.attach<ViscousRate>("fluid.viscous_rate", at_stage, target(), [&](auto& op) {
      op.viscosity = viscosity;
      op.density = density;
    });
    b.attach<ViscousStage>("fluid.viscous_stage", at_stage, alone(), [&](auto& op) {
      op.course = course;
      op.density = density;
    });
    attach_at_walls<WallForceField<MeanViscous>>("fluid.wall_viscous_acceleration", at_source);
    b.attach<least_squares::ViscousForce>("fluid.viscous_force", at_source, target());
  }

  void attach_pressure() const {
    attach_at_walls<WallForceField<SpecificForce>>("fluid.wall_specific_force", at_source);
    attach_at_walls<WallNormalForce>("fluid.wall_normal_force", at_source);
    b.attach<WaveSource>("fluid.wave_source", at_source, target(), [&](auto& op) {
      op.course = course;
      op.density = density;
    });
    attach_at_walls<WallPressure<PressureWave>>("fluid.wall_pressure_wave", at_wave);
    b.attach<WaveRate>("fluid.wave_rate", at_wave, target(), [&](auto& op) { op.course = course; });
    b.attach<WaveStep>("fluid.wave_step", at_wave, alone(), [&](auto& op) {
      op.course = course;
      op.cfl = physics.acoustic_cfl;
      op.damping = physics.damping;
      op.eigenvalue_over_norm = eigenvalue_over_norm(b.dimensions(), h_over_dx());
    });
    attach_at_walls<WallPressure<PressureImpulse>>("fluid.wall_pressure_impulse", at_arrival);
    b.attach<least_squares::PressureForce>("fluid.pressure_force", at_arrival, target(),
                                           [&](auto& op) { op.density = density; });
    b.attach<Arrival>("fluid.arrival", at_arrival, alone());
    if (physics.velocity_filter == 0.0) return;
    b.attach<VelocityFluctuation>("fluid.velocity_fluctuation", at_arrival, alone());
    b.attach<VelocityFilter>("fluid.velocity_filter", at_arrival, alone(), [&](auto& op) {
      op.strength = physics.velocity_filter;
      op.reference_density = density;
    });
  }
};

}  // namespace

void LeastSquares::build(const Builder& b) {
  b.loop("advection", {"drift", "flow"});
  b.loop("midpoint", at_flow, {"fit", "forces", "viscous", "source", "acoustic", "arrival"});
  b.loop("viscous", at_viscous, {"stage"});
  b.loop("acoustic", at_acoustic, {"wave"});
  b.renew_neighbours_in("midpoint");

  std::vector<WallBody> wall_bodies;
  for (const BodyIndex wall : walls.value()) {
    wall_bodies.push_back({wall, b.material<Wall>(wall, "fluid.wall")->slip.value() == "free_slip"});
    b.attach<SurfaceMotion>("fluid.surface_motion", {SHOAL_INITIAL, "state"},
                            FluidBody::fitted(b.target(wall)));
  }
  for (const BodyIndex body : bodies.value()) {
    const auto eos = b.material_interface<shoal_equation_of_state>(body, SHOAL_EQUATION_OF_STATE,
                                                                   SHOAL_EQUATION_OF_STATE_REVISION);
    if (!eos)
      throw CaseError(std::string("body '") + b.body(body).name +
                      "' needs a material with a density and a viscosity, e.g. material: {fluid.liquid: "
                      "{density: 1000, viscosity: 1e-3}}");
    const double density = eos.api->reference_density(eos.self);
    const FluidBody fluid{b, *this, body, density, eos.api->viscosity(eos.self) / density, wall_bodies};
    b.body_moves(body);
    b.attach<InitialMass>("fluid.initial_mass", {SHOAL_INITIAL, "state"}, fluid.alone(),
                          [&](auto& op) { op.reference_density = density; });
    fluid.attach_motion();
    fluid.attach_forces();
    fluid.attach_pressure();
    attach_kinematics(b, fluid.alone());
  }
}

}  // namespace shoal::fluid
