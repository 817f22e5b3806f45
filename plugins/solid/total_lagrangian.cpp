// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "total_lagrangian.hpp"

#include <cstdio>
#include <utility>

#include "damping.hpp"
#include "deformation.hpp"
#include "loads.hpp"
#include "measures.hpp"
#include "momentum.hpp"
#include "stages.hpp"
#include "stress.hpp"
#include "structure_step.hpp"
#include "volume_averaging.hpp"

namespace shoal::solid {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

SharedStructure structure_of(const TotalLagrangian& physics, const Builder& b, BodyIndex body) {
  auto structure = std::make_shared<Structure>();
  structure->law = b.material_interface<shoal_stress_law>(body, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
  if (!structure->law)
    throw CaseError(
        std::string("body '") + b.body(body).name +
        "' needs a material with a stress law, e.g. material: {solid.neo_hookean: {density: 1000, "
        "youngs_modulus: 1e6, poisson_ratio: 0.3}}");
  if (b.dimensions() == 2)
    structure->kinematics = physics.plane.value() == "stress" ? SHOAL_PLANE_STRESS : SHOAL_PLANE_STRAIN;
  structure->constants.size = sizeof structure->constants;
  structure->law.api->constants(structure->law.self, structure->kinematics, &structure->constants);
  const double dx = b.body(body).spacing;
  structure->settings = {physics.gradient.value() == "quadratic", 0.5 * physics.support * dx, dx,
                         physics.regularisation, physics.consistent};
  structure->hourglass = physics.hourglass * structure->constants.shear_modulus;
  return structure;
}

struct SolidBody {
  const Builder& b;
  const TotalLagrangian& physics;
  BodyIndex body;
  SharedStructure structure = structure_of(physics, b, body);

  Target itself() const { return b.target(body); }
  Target reference() const { return reference_target(b, body, *structure); }

  template <class Op>
  void declare_law_fields(Op& op, bool writes) const {
    std::uint32_t n = 0;
    const shoal_access* fields = structure->law.api->fields(structure->law.self, structure->kinematics, &n);
    op.law_fields.declare(n, fields, writes);
    op.structure = structure;
  }

  void attach_initial() const {
    b.attach<InitialState>("solid.initial_state", {SHOAL_INITIAL, "state"}, itself(),
                           [&](auto& op) { declare_law_fields(op, true); });
    if (physics.viscosity > 0.0)
      b.attach<InitialKelvinVoigt>("solid.kelvin_voigt.initial", {SHOAL_INITIAL, "state"}, itself());
    b.attach<SurfaceArea>(
        "solid.surface_area", {SHOAL_INITIAL, "state"}, reference(),
        [&](auto& op) { op.structure = structure; }, SHOAL_OPERATOR_ON_DEMAND);
  }
  // What outputs and probes ask for: each runs only if somebody does.
  template <class Op, class Setup>
  void on_demand(const char* name, Target target, Setup&& setup) const {
    b.attach<Op>(name, {SHOAL_SAMPLE, "measures"}, std::move(target), std::forward<Setup>(setup),
                 SHOAL_OPERATOR_ON_DEMAND);
  }
  template <class Op>
  void on_demand(const char* name) const {
    on_demand<Op>(name, itself(), [](Op&) {});
  }
  // The averaged volume ratio and what follows from it.
  bool averages() const {
    const std::string_view word = physics.average_volume->word;
    if (word == "never" || structure->law.api->volumetric_pressure == nullptr) return false;
    return word == "always" || structure->constants.bulk_modulus > 10.0 * structure->constants.shear_modulus;
  }
  void attach_averaging(At at, const AveragingFields& names, std::uint32_t flags) const {
    const auto attach = [&]<class Op>(const char* name, const Target& target) {
      b.attach<Op>(
          name, at, target,
          [&](Op& op) {
            op.rename(names);
            if constexpr (requires { op.structure; }) op.structure = structure;
          },
          flags);
    };
    attach.operator()<VolumeRatio>("solid.volume_ratio", itself());
    attach.operator()<MeanVolumeRatio>("solid.mean_volume_ratio", reference());
    attach.operator()<MeanPressureOfVolume>("solid.mean_pressure", itself());
    attach.operator()<PressureCorrection>("solid.pressure_correction", reference());
    attach.operator()<CorrectedStress>("solid.corrected_stress", itself());
  }
  void attach_current_state() const {
    on_demand<DeformationGradient>("solid.deformation_gradient.current", reference(), [&](auto& op) {
      op.structure = structure;
      op.F.rename("current_deformation_gradient");
      op.hourglass.rename("current_hourglass_stress");
    });
    on_demand<Stress>("solid.stress.current", itself(), [&](auto& op) {
      declare_law_fields(op, false);
      op.trial = true;
      op.F.rename("current_deformation_gradient");
      op.P.rename("current_piola_stress");
    });
    if (averages()) attach_averaging({SHOAL_SAMPLE, "measures"}, current_averaging, SHOAL_OPERATOR_ON_DEMAND);
    on_demand<InternalForce>("solid.internal_force.current", reference(), [&](auto& op) {
      op.structure = structure;
      op.P.rename("current_piola_stress");
      op.hourglass.rename("current_hourglass_stress");
      op.acceleration.rename("current_internal_acceleration");
    });
  }
  void attach_measures() const {
    attach_current_state();
    on_demand<Displacement>("solid.displacement");
    on_demand<CauchyStress>("solid.cauchy_stress", itself(),
                            [&](auto& op) { declare_law_fields(op, false); });
    if (averages()) on_demand<AveragedCauchyStress>("solid.averaged_cauchy_stress");
    on_demand<VonMises>("solid.von_mises");
    on_demand<PrincipalStress>("solid.principal_stress");
    on_demand<MeanPressure>("solid.pressure");
    on_demand<StrainEnergy>("solid.strain_energy", itself(),
                            [&](auto& op) { declare_law_fields(op, false); });
    if (averages())
      on_demand<AveragedStrainEnergy>("solid.averaged_strain_energy", itself(),
                                      [&](auto& op) { op.structure = structure; });
    const double dx = structure->settings.spacing;
    on_demand<HourglassEnergy>("solid.hourglass_energy", itself(),
                               [&](auto& op) { op.stiffness = structure->hourglass / (dx * dx); });
    on_demand<NonAffine>("solid.non_affine", reference(), [&](auto& op) { op.structure = structure; });
  }
  void attach_damping() const {
    if (physics.damping > 0.0)
      b.attach<MassDamping>("solid.mass_damping", at_forces, itself(),
                            [&](auto& op) { op.coefficient = physics.damping; });
    if (physics.artificial_viscosity > 0.0)
      b.attach<PairDamping>("solid.pair_damping", at_forces, reference(), [&](auto& op) {
        op.strength = physics.artificial_viscosity * structure->constants.longitudinal_speed *
                      structure->settings.smoothing_length;
      });
  }
  void attach_step() const {
    b.attach<Drift>("solid.drift", at_drift, itself());
    b.attach<DeformationGradient>("solid.deformation_gradient", at_deformation, reference(),
                                  [&](auto& op) { op.structure = structure; });
    b.attach<Stress>("solid.stress", at_stress, itself(), [&](auto& op) { declare_law_fields(op, true); });
    if (averages()) attach_averaging(at_stress, loop_averaging, 0);
    if (physics.viscosity > 0.0)
      b.attach<KelvinVoigt>("solid.kelvin_voigt", at_stress, itself(),
                            [&](auto& op) { op.viscosity = physics.viscosity; });
    if (structure->law.api->wave_speed != nullptr)
      b.attach<WaveSpeed>("solid.wave_speed", at_stress, itself(),
                          [&](auto& op) { declare_law_fields(op, false); });
    b.attach<InternalForce>("solid.internal_force", at_forces, reference(), [&](auto& op) {
      op.structure = structure;
      op.counts_weights = true;
    });
    b.own_field(body, "acceleration", at_forces);
    const Vector3 g = b.gravity();
    if (g != Vector3{})
      b.attach<Gravity>("solid.gravity", at_forces, itself(), [&](auto& op) { op.gravity = g; });
    attach_damping();
    b.attach<Kick>("solid.kick", at_kick, itself());
    b.attach<StableStep>("solid.stable_step", at_kick, reference(), [&](auto& op) {
      op.structure = structure;
      op.factor = physics.step_factor;
      op.viscosity = physics.viscosity;
    });
  }
};

}  // namespace

void TotalLagrangian::build(const Builder& b) {
  declare_loop(b);
  for (const BodyIndex body : bodies.value()) {
    const SolidBody solid{b, *this, body};
    b.body_moves(body);
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
