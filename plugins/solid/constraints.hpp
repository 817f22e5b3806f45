// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Particles whose motion is given: solid.clamp holds them where they are, solid.prescribed_motion moves them.
//
// Held particles carry stress like all others; three or four layers of them make a clamp. The plane where the body is
// effectively clamped lies a quarter to half a spacing behind the last held centre, so a clamp at a plane x = 0 holds
// the particles with x < dx, the first row in front of the plane among them (measured on the oscillating plate and
// on CSM1: without it the structure is too long by about half a spacing).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "region.hpp"
#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::solid {

enum class Motion { held, displacement, velocity };

// Sets position and velocity of the particles of a region at the end of a step, or the position at its middle.
struct PrescribedMotion : ParticleOperator<PrescribedMotion> {
  In<Vector> reference_position{"reference_position"};
  InOut<Vector> position{"position"};
  InOut<Vector> velocity{"velocity"};

  RegionValues region;
  Motion motion = Motion::held;
  VectorExpression given;
  std::array<bool, 3> axes{true, true, true};
  bool half_step = false;
  std::shared_ptr<void> kept;  // what else lives as long as the operator

  void begin();
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    for (const std::uint64_t i : region.particles(chunk.begin, chunk.end)) move(Particle<D>{i, nullptr});
  }

 private:
  void move(auto i) const {
    for (int a = 0; a < decltype(i)::dimensions; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (!axes[k]) continue;
      const double v = motion == Motion::held ? 0.0 : rate_[k][i.index];
      if (motion == Motion::velocity)
        position[i][a] += 0.5 * dt() * (v - velocity[i][a]);
      else
        position[i][a] = reference_position[i][a] + (motion == Motion::held ? 0.0 : value_[k][i.index]);
      if (!half_step) velocity[i][a] = v;
    }
  }

  std::array<std::vector<double>, 3> value_, rate_;  // displacement, velocity
};

// The force that a constraint exerts on its particles against stress and loads, -m (a_internal + a), where a is what
// loads, damping and contact add; the inertia of particles that are moved, m dv/dt, is not in it. Several
// constraints of a body add to the same field, so each writes its own particles alone.
struct ReactionForce : ParticleOperator<ReactionForce> {
  In<Vector> reference_position{"reference_position"};
  In<Vector> internal{"current_internal_acceleration", unit("m/s2"),
                      doc("Acceleration by stress at the time of the output.")};
  In<Vector> acceleration{"acceleration"};
  In<Scalar> mass{"mass"};
  InOut<Vector> reaction{"reaction_force", unit("N"), doc("Force of the constraints on a particle.")};

  Region region;
  std::array<bool, 3> axes{true, true, true};

  void begin() {
    if (!region.looked()) region.look(dimensions(), n_particles(), reference_position.data());
  }
  void particle(auto i) const {
    if (!region.holds(i.index)) return;
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      if (axes[static_cast<std::size_t>(a)])
        reaction[i][a] = -mass[i] * (internal[i][a] + acceleration[i][a]);
  }
};

// Tells who asks (relaxation.hpp) which components of the motion are given.
struct HeldAxes : ParticleOperator<HeldAxes> {
  In<Vector> reference_position{"reference_position"};
  InOut<Integer> held{"held_axes", unit("1"), doc("Bit a: the motion along axis a is given.")};
  Region region;
  std::array<bool, 3> axes{true, true, true};

  void begin() {
    if (!region.looked()) region.look(dimensions(), n_particles(), reference_position.data());
  }
  void particle(auto i) const {
    if (!region.holds(i.index)) return;
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      if (axes[static_cast<std::size_t>(a)]) held[i] |= std::int64_t{1} << a;
  }
};

struct Clamp final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies.", example("[beam]")};
  Param<Expression> where{
      "where", "1",
      "Condition on the reference position (x, y, z) that the held particles meet; a clamp at a "
      "plane should hold the first row of particles in front of it too.",
      optional, example("x < dx")};
  Param<ObjectHandle> within{"within",
                             nullptr,
                             "Shape whose particles are held.",
                             ObjectsOf{SHOAL_TYPE_SHAPE},
                             optional,
                             example("{ball: {centre: [0.2, 0.2], radius: 0.05}}")};
  Param<ObjectHandle> built_into{
      "built_into",
      nullptr,
      "Rigid shape that the body is built into, instead of `where` and `within`: the displacement vanishes "
      "at "
      "its surface, curved or flat, wherever the particles lie. The body goes on behind the surface by two "
      "spacings or more.",
      ObjectsOf{SHOAL_TYPE_SHAPE},
      optional,
      example("{ball: {centre: [0.2, 0.2], radius: 0.05}}")};
  Param<std::vector<Choice>> axes{"axes",
                                  nullptr,
                                  "Directions that are held; all without it. A plane of symmetry "
                                  "holds its normal.",
                                  one_of("x", "y", "z"),
                                  optional,
                                  example("[x]")};
  void build(const Builder& builder);
};

struct PrescribedMotionPhysics final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies.", example("[beam]")};
  Param<Expression> where{"where", "1",
                          "Condition on the reference position (x, y, z) that the particles meet.", optional,
                          example("x > L - 4*dx")};
  Param<ObjectHandle> within{"within",
                             nullptr,
                             "Shape whose particles are moved.",
                             ObjectsOf{SHOAL_TYPE_SHAPE},
                             optional,
                             example("{box: {lower: [0, 0], upper: [0.1, 1]}}")};
  Param<std::vector<Choice>> axes{
      "axes",   nullptr,       "Directions that are prescribed; all without it.", one_of("x", "y", "z"),
      optional, example("[x]")};
  Param<VectorExpression> displacement{"displacement", "m",
                                       "Displacement as expressions of the reference position and t.",
                                       optional, example("[\"0.1*t\", 0]")};
  Param<VectorExpression> velocity{"velocity", "m/s",
                                   "Velocity as expressions of the reference position and t.", optional,
                                   example("[0, \"sin(10*t)\"]")};
  void build(const Builder& builder);
};

}  // namespace shoal::solid
