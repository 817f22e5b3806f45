// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "wcsph.hpp"

#include <cmath>
#include <cstdio>
#include <memory>

#include "shoal/freeze_geometry.hpp"

#include "acoustic_step.hpp"
#include "advection_step.hpp"
#include "central_viscosity.hpp"
#include "density.hpp"
#include "density_diffusion.hpp"
#include "gradient_matrix.hpp"
#include "kinematics.hpp"
#include "lattice.hpp"
#include "liquid.hpp"
#include "riemann.hpp"
#include "shift_carry.hpp"
#include "surface_shift.hpp"
#include "velocity_filter.hpp"
#include "viscosity.hpp"
#include "wall.hpp"

namespace shoal::fluid {
namespace {

constexpr At at_shift{"advection", "shift"};
constexpr At at_apply_shift{"advection", "apply_shift"};
constexpr At at_density{"advection", "density"};
constexpr At at_geometry{"advection", "geometry"};
constexpr At at_filter{"advection", "filter"};
constexpr At at_forces{"advection", "forces"};
constexpr At at_acoustic{"advection", "acoustic"};
constexpr At at_predict{"acoustic", "predict"};
constexpr At at_momentum{"acoustic", "momentum"};
constexpr At at_kick{"acoustic", "kick"};
constexpr At at_continuity{"acoustic", "continuity"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Extent along gravity of all fluid together, at least one particle, m.
double height(const Builder& b, const std::vector<BodyIndex>& bodies, const Vector3& g, double magnitude) {
  double low = HUGE_VAL, high = -HUGE_VAL, spacing = 0;
  for (const BodyIndex index : bodies) {
    const shoal_body& body = b.body(index);
    spacing = std::max(spacing, body.spacing);
    for (int corner = 0; corner < 8; ++corner) {
      double along = 0;
      for (unsigned a = 0; a < 3; ++a)
        along += g[a] / magnitude * ((corner >> a & 1) ? body.upper[a] : body.lower[a]);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  return std::max(high - low, spacing);
}

// What the operators of one fluid body share.
struct FluidBody {
  const Builder& b;
  const Wcsph& physics;
  BodyIndex body;
  std::vector<BodyIndex> walls, no_slip_walls;
  EquationOfState equation_of_state;
  double density, viscosity, sound_speed, max_speed;
  LatticeSums lattice = lattice_sums(b.dimensions(), b.target(body));
  // Of the sums over pairs in acoustic steps and, in 3D, of the filter. With corrected gradients they are in double
  // precision, since in 2D geometry would be frozen: with edac and L/50 the energy of Taylor-Green vortices is 0.8 % off
  // with it, 0.2 % without.
  std::shared_ptr<SinglePrecision> single =
      physics.precision.value() == "single" && !physics.gradient_correction
          ? std::make_shared<SinglePrecision>()
          : nullptr;

  // Of walls, whose records last as long as the walls rest.
  std::shared_ptr<SinglePrecision> single_of_its_own() const {
    return single ? std::make_shared<SinglePrecision>() : nullptr;
  }

  bool has_walls() const { return !walls.empty(); }
  Target itself() const { return b.target(body); }
  Target and_walls() const { return b.target(body, walls); }

  void attach_initial() const {
    b.attach<InitialState>("fluid.initial_state", {SHOAL_INITIAL, "state"}, itself(),
                           [&](auto& op) { op.equation_of_state = equation_of_state; });
  }

  void attach_shift() const {
    const double factor = physics.shift_strength.value_or(physics.free_surface ? 0.0 : 0.5);
    if (factor == 0.0) return;
    const auto strength = [&](auto& op) {
      op.strength = factor;
      if constexpr (requires { op.gradient_scale; }) op.gradient_scale = 1.0 / lattice.slope;
    };
    if (physics.free_surface) {
      b.attach<Crowding>("fluid.crowding", at_shift, itself(), strength);
      if (has_walls()) b.attach<WallCrowding>("fluid.crowding.walls", at_shift, and_walls(), strength);
      b.attach<AlongSurface>("fluid.along_surface", at_shift, itself());
    } else {
      b.attach<TransportShift>("fluid.transport_shift", at_shift, itself(), strength);
      if (has_walls())
        b.attach<WallTransportShift>("fluid.transport_shift.walls", at_shift, and_walls(), strength);
    }
    if (physics.carry_velocity) {
      b.attach<ShiftChange>("fluid.shift_change", at_apply_shift, itself());
      b.attach<CarryVelocity>("fluid.carry_velocity", at_apply_shift, itself());
    }
    b.attach<ApplyShift>("fluid.apply_shift", at_apply_shift, itself());
  }

  void attach_density() const {
    if (!physics.density_summation) return;
    const Target target = itself();
    const std::uint64_t interval = physics.free_surface ? 2 : 1;
    const auto setup = [&](auto& op) {
      op.reference_density = density;
      op.per_lattice_sum = 1.0 / lattice.w;
      op.single = single;
      op.free_surface = physics.free_surface;
      op.interval = interval;
      const double share = physics.free_surface ? physics.summation_relaxation.value() : 1.0;
      op.relaxation = std::min(1.0, static_cast<double>(interval) * share);
      op.tolerance = physics.free_surface ? physics.summation_tolerance * density : 0.0;
    };
    if (has_walls()) {
      b.attach<WallDensity>("fluid.density.walls", at_density, and_walls(),
                            [&](auto& op) { op.interval = interval; });
      b.attach<DensityReinitialisationAtWalls>("fluid.density", at_density, target, setup);
    } else {
      b.attach<DensityReinitialisation>("fluid.density", at_density, target, setup);
    }
  }

  void attach_geometry() const {
    if (!single || b.dimensions() == 3) return;
    b.attach<FreezeGeometry>("fluid.pair_geometry", at_geometry, itself(),
                             [&](auto& op) { op.single = single; });
  }

  void attach_gradients() const {
    b.attach<GradientMoment>("fluid.gradient_moment", at_filter, itself());
    if (has_walls()) b.attach<WallGradientMoment>("fluid.gradient_moment.walls", at_filter, and_walls());
    b.attach<GradientMatrix>("fluid.gradient_matrix", at_filter, itself(),
                             [&](auto& op) { op.slope = lattice.slope; });
  }

  void attach_filter() const {
    const double strength = physics.velocity_filter.value_or(physics.free_surface ? 0.4 : 0.0);
    if (strength == 0.0) return;
    constexpr std::uint64_t interval = 2;
    b.attach<VelocityFluctuation>("fluid.velocity_fluctuation", at_filter, itself(), [&](auto& op) {
      op.interval = interval;
      op.single = single;
    });
    b.attach<VelocityFilter>("fluid.velocity_filter", at_filter, itself(), [&](auto& op) {
      op.interval = interval;
      op.single = single;
      op.strength = strength;
      op.reference_density = density;
    });
  }

  void attach_forces() const {
    b.own_field(body, "acceleration", at_forces);
    b.attach<AdvectionStep>("fluid.advection_step", at_forces, itself(), [&](auto& op) {
      op.expected_speed = max_speed;
      op.cfl = physics.advection_cfl;
    });
    const Vector3 g = b.gravity();
    if (g != Vector3{})
      b.attach<Gravity>("fluid.gravity", at_forces, itself(), [&](auto& op) { op.gravity = g; });
    if (viscosity == 0.0) return;
    physics.viscous_force.value() == "morris"
        ? attach_viscosity<ViscousForce, WallViscousForce>()
        : attach_viscosity<CentralViscousForce, WallCentralViscousForce>();
  }
  template <class Force, class WallForce>
  void attach_viscosity() const {
    const auto setup = [&](auto& op) {
      op.viscosity = viscosity;
      op.gradient_scale = 1.0 / lattice.slope;
      if constexpr (requires { op.reference_density; }) op.reference_density = density;
      if constexpr (requires { op.single; }) op.single = single;
      if constexpr (requires { op.longest_step; })
        op.longest_step = no_slip_walls.empty() ? Force::longest_step_in_the_open : 0.125;
    };
    b.attach<Force>("fluid.viscous_force", at_forces, itself(), setup);
    if (!no_slip_walls.empty())
      b.attach<WallForce>("fluid.viscous_force.walls", at_forces, b.target(body, no_slip_walls), setup);
  }

  template <bool Corrected>
  void attach_pressure_force() const {
    const Choice kind = physics.stabilisation;
    const auto setup = [&](auto& op) {
      op.reference_density = density;
      op.sound_speed = sound_speed;
      op.gradient_scale = 1.0 / lattice.slope;
      op.single = single;
      if constexpr (requires { op.dissipation; }) op.dissipation = largest_dissipation();
      if constexpr (requires { op.diffusivity; }) {
        const double ch = sound_speed * itself().smoothing_length;
        op.diffusivity = kind == "edac" ? physics.diffusion.value_or(0.5) * ch / 8.0
                                        : physics.diffusion.value_or(0.1) * ch;
        op.gravity = b.gravity();
      }
    };
    const auto attach = [&]<class Op>() {
      b.attach<Op>("fluid.pressure_force", at_momentum, itself(), setup);
    };
    if (kind == "riemann") attach.template operator()<PressureForceOf<Corrected>>();
    if (kind == "antuono")
      attach.template operator()<DiffusivePressureForce<Diffusion::antuono, Corrected>>();
    if (kind == "fourtakas")
      attach.template operator()<DiffusivePressureForce<Diffusion::fourtakas, Corrected>>();
    if (kind == "edac") attach.template operator()<DiffusivePressureForce<Diffusion::edac, Corrected>>();
    if (kind == "none") attach.template operator()<DiffusivePressureForce<Diffusion::none, Corrected>>();
  }

  // B of riemann.hpp.
  double largest_dissipation() const {
    return std::max(physics.largest_dissipation.value(), physics.least_dissipation.value());
  }
  // Other stabilisations diffuse pressure less than acoustic steps bear.
  double longest_step() const {
    return longest_acoustic_step(physics.acoustic_damping,
                                 physics.stabilisation.value() == "riemann" ? largest_dissipation() : 0.0);
  }

  template <bool Corrected>
  void attach_acoustic() const {
    b.attach<AcousticPredictor>("fluid.predict", at_predict, itself(), [&](auto& op) {
      op.equation_of_state = equation_of_state;
      op.sound_speed = sound_speed;
      op.cfl = physics.acoustic_cfl * longest_step();
      op.damping = physics.acoustic_damping;
    });
    attach_pressure_force<Corrected>();
    if (has_walls())
      b.attach<WallPressureForceOf<Corrected>>("fluid.pressure_force.walls", at_momentum, and_walls(),
                                               [&](auto& op) {
                                                 op.reference_density = density;
                                                 op.gradient_scale = 1.0 / lattice.slope;
                                                 op.single = single_of_its_own();
                                                 if (physics.free_surface)
                                                   op.touching = 0.25 * itself().spacing;
                                               });
    b.attach<Kick>("fluid.kick", at_kick, itself());
    const auto riemann = [&](auto& op) {
      op.sound_speed = sound_speed;
      op.limiter = physics.dissipation_limiter;
      op.most = largest_dissipation();
      op.gradient_scale = 1.0 / lattice.slope;
    };
    if (physics.stabilisation.value() == "riemann")
      b.attach<VelocityDivergenceOf<Corrected>>("fluid.divergence", at_continuity, itself(), [&](auto& op) {
        riemann(op);
        op.reference_density = density;
        op.least = physics.least_dissipation;
        op.single = single;
      });
    else
      b.attach<ViscousDivergence<Corrected>>("fluid.divergence", at_continuity, itself(), [&](auto& op) {
        op.alpha = physics.artificial_viscosity;
        op.single = single;
        op.sound_speed = sound_speed;
        op.reference_density = density;
        op.gradient_scale = 1.0 / lattice.slope;
      });
    if (has_walls())
      b.attach<WallVelocityDivergenceOf<Corrected>>("fluid.divergence.walls", at_continuity, and_walls(),
                                                    [&](auto& op) {
                                                      riemann(op);
                                                      op.single = single_of_its_own();
                                                    });
    b.attach<DensityCorrector>("fluid.correct_density", at_continuity, itself());
  }

  // The force on a wall, for those who ask for it.
  template <bool Corrected>
  void attach_wall_forces() const {
    for (const BodyIndex wall : walls) {
      const bool sticks = std::any_of(no_slip_walls.begin(), no_slip_walls.end(),
                                      [&](BodyIndex other) { return other.value == wall.value; });
      Target target = b.target(wall, {body});
      target.smoothing_kernel = itself().smoothing_kernel;
      target.smoothing_length = itself().smoothing_length;
      target.cutoff = itself().cutoff;
      b.attach<WallForceOf<Corrected>>(
          "fluid.wall_force", {SHOAL_SAMPLE, "forces"}, target,
          [&](auto& op) {
            op.reference_density = density;
            op.sound_speed = sound_speed;
            op.viscosity = sticks ? viscosity : 0.0;
            op.limiter = physics.dissipation_limiter;
            op.most = largest_dissipation();
            op.gradient_scale = 1.0 / lattice.slope;
            if (physics.free_surface) op.touching = 0.25 * itself().spacing;
          },
          SHOAL_OPERATOR_ON_DEMAND);
    }
  }
};

// The largest speed: given, or that of a fall through the fluid's height.
double expected_speed(const Wcsph& physics, const Builder& b) {
  if (physics.max_speed.is_set()) return physics.max_speed;
  const Vector3 g = b.gravity();
  const double magnitude = std::hypot(g[0], g[1], g[2]);
  if (magnitude == 0.0)
    throw CaseError(
        "fluid.wcsph needs max_speed, the largest speed that the flow will reach (without gravity there is "
        "nothing to estimate it from), e.g. max_speed: 1 m/s");
  return 2.0 * std::sqrt(magnitude * height(b, physics.bodies, g, magnitude));
}

}  // namespace

void Wcsph::build(const Builder& b) {
  b.loop("advection", {"shift", "apply_shift", "density", "geometry", "filter", "forces", "acoustic"});
  b.loop("acoustic", at_acoustic, {"predict", "momentum", "kick", "continuity"});
  b.renew_neighbours_in("advection");

  std::vector<BodyIndex> no_slip_walls;
  for (const BodyIndex wall : walls.value())
    if (b.material<Wall>(wall, "fluid.wall")->slip.value() == "no_slip") no_slip_walls.push_back(wall);

  const double speed = expected_speed(*this, b);
  for (const BodyIndex body : bodies.value()) {
    const auto eos = b.material_interface<shoal_equation_of_state>(body, SHOAL_EQUATION_OF_STATE,
                                                                   SHOAL_EQUATION_OF_STATE_REVISION);
    if (!eos)
      throw CaseError(
          std::string("body '") + b.body(body).name +
          "' needs a material with an equation of state, e.g. material: {fluid.liquid: {density: 1000}}");
    const double rho0 = eos.api->reference_density(eos.self);
    const double c = eos.api->set_sound_speed(eos.self, 10.0 * speed);
    const FluidBody fluid{b, *this, body, walls, no_slip_walls, eos, rho0, eos.api->viscosity(eos.self),
                          c, speed};
    b.body_moves(body);
    b.guard(body, "density", 0.5 * rho0, 2.0 * rho0);
    b.note(std::string(b.body(body).name) + ": sound speed " + number(c) + " m/s for an expected speed of " +
           number(speed) + " m/s (Mach " + number(speed / c) + ")");
    fluid.attach_initial();
    fluid.attach_shift();
    fluid.attach_density();
    fluid.attach_geometry();
    if (gradient_correction) fluid.attach_gradients();
    fluid.attach_filter();
    fluid.attach_forces();
    gradient_correction ? fluid.attach_acoustic<true>() : fluid.attach_acoustic<false>();
    attach_kinematics(b, fluid.itself());
    gradient_correction ? fluid.attach_wall_forces<true>() : fluid.attach_wall_forces<false>();
  }
}

}  // namespace shoal::fluid
