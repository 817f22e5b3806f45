// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "total_lagrangian.hpp"

#include <cstdio>

#include "damping.hpp"
#include "stages.hpp"
#include "stress.hpp"
#include "structure_step.hpp"

namespace shoal::solid {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

struct MovingBody : SolidBody {
  const TotalLagrangian& motion;

  MovingBody(const Builder& builder, const TotalLagrangian& physics_, BodyIndex index)
      : SolidBody(builder, physics_, index), motion(physics_) {}

  void attach_damping() const {
    if (motion.damping > 0.0)
      b.attach<MassDamping>("solid.mass_damping", at_forces, itself(),
                            [&](auto& op) { op.coefficient = motion.damping; });
    if (motion.artificial_viscosity > 0.0)
      b.attach<PairDamping>("solid.pair_damping", at_forces, reference(), [&](auto& op) {
        op.strength = motion.artificial_viscosity * structure->constants.longitudinal_speed *
                      structure->settings.smoothing_length;
      });
  }
  void attach_step() const {
    if (motion.viscosity > 0.0)
      b.attach<InitialKelvinVoigt>("solid.kelvin_voigt.initial", {SHOAL_INITIAL, "state"}, itself());
    b.attach<Drift>("solid.drift", at_drift, itself());
    attach_deformation();
    attach_stress();
    if (motion.viscosity > 0.0)
      b.attach<KelvinVoigt>("solid.kelvin_voigt", at_stress, itself(),
                            [&](auto& op) { op.viscosity = motion.viscosity; });
    if (structure->law.api->wave_speed != nullptr)
      b.attach<WaveSpeed>("solid.wave_speed", at_stress, itself(),
                          [&](auto& op) { declare_law_fields(op, false); });
    attach_forces();
    attach_damping();
    b.attach<Kick>("solid.kick", at_kick, itself());
    b.attach<StableStep>("solid.stable_step", at_kick, reference(), [&](auto& op) {
      op.structure = structure;
      op.factor = motion.step_factor;
      op.viscosity = motion.viscosity;
      op.damping = motion.damping + pair_damping_rate(motion.artificial_viscosity, structure->constants,
                                                      structure->settings.smoothing_length, b.dimensions());
      op.added = added_stiffness(b, body);
    });
  }
};

}  // namespace

void TotalLagrangian::build(const Builder& b) {
  declare_loop(b);
  for (const BodyIndex body : bodies.value()) {
    const MovingBody solid(b, *this, body);
    const shoal_elastic_constants& constants = solid.structure->constants;
    b.note(std::string(b.body(body).name) + ": speed of longitudinal waves " +
           number(constants.longitudinal_speed) + " m/s, of shear waves " + number(constants.shear_speed) +
           " m/s");
    solid.attach_initial();
    solid.attach_step();
    solid.attach_measures();
  }
}

}  // namespace shoal::solid
