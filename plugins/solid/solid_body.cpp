// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "solid_body.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "deformation.hpp"
#include "loads.hpp"
#include "measures.hpp"
#include "momentum.hpp"
#include "pressure_noise.hpp"
#include "stages.hpp"
#include "stress.hpp"
#include "volume_averaging.hpp"

namespace shoal::solid {
namespace {

// The state and the forces of a body belong to one physics, which is named once.
void claim(const SolidPhysics& physics, const Builder& b, BodyIndex body, const SharedStructure& structure) {
  static std::map<std::pair<const void*, std::uint32_t>, std::weak_ptr<Structure>> known;
  std::weak_ptr<Structure>& entry = known[{structure->law.self, body.value}];
  if (!entry.expired())
    throw CaseError(physics.bodies.place() + ": body '" + b.body(body).name +
                    "' is named twice; each solid body has one solid.total_lagrangian or one "
                    "solid.quasi_static");
  entry = structure;
}

SharedStructure structure_of(const SolidPhysics& physics, const Builder& b, BodyIndex body) {
  auto structure = std::make_shared<Structure>();
  structure->law = b.material_interface<shoal_stress_law>(body, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
  if (!structure->law)
    throw CaseError(
        std::string("body '") + b.body(body).name +
        "' needs a material with a stress law, e.g. material: {solid.neo_hookean: {density: 1000, "
        "youngs_modulus: 1e6, poisson_ratio: 0.3}}");
  if (b.dimensions() == 2)
    structure->kinematics = physics.plane.value() == "stress" ? SHOAL_PLANE_STRESS : SHOAL_PLANE_STRAIN;
  else if (physics.plane.value() == "stress")
    throw CaseError(physics.plane.place() + ": plane: stress is for two dimensions; leave it out");
  structure->constants.size = sizeof structure->constants;
  structure->law.api->constants(structure->law.self, structure->kinematics, &structure->constants);
  const double dx = b.body(body).spacing;
  structure->settings = {physics.gradient.value() == "quadratic", 0.5 * physics.support * dx, dx,
                         physics.regularisation, physics.consistent};
  if (physics.average_volume->word == "always" && structure->law.api->volumetric_pressure == nullptr)
    throw CaseError(physics.average_volume.place() + ": the material of body '" + b.body(body).name +
                    "' does not keep volume and shape apart, so there is no pressure to average; "
                    "solid.neo_hookean (form: split) and solid.mooney_rivlin do");
  if (physics.average_volume->word == "always" && structure->kinematics == SHOAL_PLANE_STRESS)
    throw CaseError(physics.average_volume.place() +
                    ": in plane stress a sheet keeps its volume by its thickness, so there is no pressure to "
                    "average; leave average_volume out, or take plane: strain");
  claim(physics, b, body, structure);
  structure->end_correction = physics.end_correction;
  structure->held = held_regions(b, body);
  structure->hourglass = physics.hourglass * structure->constants.shear_modulus;
  return structure;
}

}  // namespace

SolidBody::SolidBody(const Builder& builder, const SolidPhysics& physics_, BodyIndex index)
    : b(builder), physics(physics_), body(index), structure(structure_of(physics_, builder, index)) {}

void SolidBody::attach_initial() const {
  b.attach<InitialState>("solid.initial_state", {SHOAL_INITIAL, "state"}, itself(),
                         [&](auto& op) { declare_law_fields(op, true); });
  b.attach<InitialWeights>("solid.reference_weights", {SHOAL_INITIAL, "state"}, reference(),
                           [&](auto& op) { op.structure = structure; });
  b.attach<SurfaceArea>(
      "solid.surface_area", {SHOAL_INITIAL, "state"}, reference(),
      [&](auto& op) { op.structure = structure; }, SHOAL_OPERATOR_ON_DEMAND);
}

void SolidBody::attach_deformation() const {
  const auto attach = [&]<class Op>() {
    b.attach<Op>("solid.deformation_gradient", at_deformation, reference(),
                 [&](auto& op) { op.structure = structure; });
  };
  controls() ? attach.operator()<DeformationGradientOf<true>>()
             : attach.operator()<DeformationGradientOf<false>>();
}

void SolidBody::attach_stress() const {
  b.attach<Stress>("solid.stress", at_stress, itself(), [&](auto& op) { declare_law_fields(op, true); });
  if (averages()) attach_averaging(at_stress, loop_averaging, 0);
}

void SolidBody::attach_forces() const {
  const auto attach = [&]<class Op>() {
    b.attach<Op>("solid.internal_force", at_forces, reference(), [&](auto& op) {
      op.structure = structure;
      op.counts_weights = true;
    });
  };
  controls() ? attach.operator()<InternalForceOf<true>>() : attach.operator()<InternalForceOf<false>>();
  b.own_field(body, "acceleration", at_forces);
  const Vector3 g = b.gravity();
  if (g != Vector3{})
    b.attach<Gravity>("solid.gravity", at_forces, itself(), [&](auto& op) { op.gravity = g; });
}

template <class Op, class Setup>
void SolidBody::on_demand(const char* name, Target target, Setup&& setup) const {
  b.attach<Op>(name, {SHOAL_SAMPLE, "measures"}, std::move(target), std::forward<Setup>(setup),
               SHOAL_OPERATOR_ON_DEMAND);
}
template <class Op>
void SolidBody::on_demand(const char* name) const {
  on_demand<Op>(name, itself(), [](Op&) {});
}
// The averaged volume ratio and what follows from it.
bool SolidBody::averages() const {
  const std::string_view word = physics.average_volume->word;
  if (word == "never" || structure->law.api->volumetric_pressure == nullptr) return false;
  if (structure->kinematics == SHOAL_PLANE_STRESS) return false;  // a sheet keeps its volume by its thickness
  return word == "always" || structure->constants.bulk_modulus > 10.0 * structure->constants.shear_modulus;
}
void SolidBody::attach_averaging(At at, const AveragingFields& names, std::uint32_t flags) const {
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
  attach.operator()<PressureCorrection>("solid.pressure_correction", itself());
  attach.operator()<CorrectedStress>("solid.corrected_stress", itself());
}
template <bool Hourglass>
void SolidBody::attach_current_state() const {
  on_demand<DeformationGradientOf<Hourglass>>("solid.deformation_gradient.current", reference(),
                                              [&](auto& op) {
                                                op.structure = structure;
                                                op.F.rename("current_deformation_gradient");
                                                if constexpr (Hourglass)
                                                  op.hourglass.rename("current_hourglass_stress");
                                              });
  on_demand<Stress>("solid.stress.current", itself(), [&](auto& op) {
    declare_law_fields(op, false);
    op.trial = true;
    op.F.rename("current_deformation_gradient");
    op.P.rename("current_piola_stress");
  });
  if (averages()) attach_averaging({SHOAL_SAMPLE, "measures"}, current_averaging, SHOAL_OPERATOR_ON_DEMAND);
  on_demand<InternalForceOf<Hourglass>>("solid.internal_force.current", reference(), [&](auto& op) {
    op.structure = structure;
    op.P.rename("current_piola_stress");
    if constexpr (Hourglass) op.hourglass.rename("current_hourglass_stress");
    op.acceleration.rename("current_internal_acceleration");
  });
}
void SolidBody::attach_measures() const {
  controls() ? attach_current_state<true>() : attach_current_state<false>();
  on_demand<Displacement>("solid.displacement");
  on_demand<CauchyStress>("solid.cauchy_stress", itself(), [&](auto& op) { declare_law_fields(op, false); });
  if (averages()) on_demand<AveragedCauchyStress>("solid.averaged_cauchy_stress");
  on_demand<VonMises>("solid.von_mises");
  on_demand<PrincipalStress>("solid.principal_stress");
  on_demand<MeanPressure>("solid.pressure");
  on_demand<PressureNoise>("solid.pressure_noise", reference(), [&](auto& op) { op.structure = structure; });
  on_demand<StrainEnergy>("solid.strain_energy", itself(), [&](auto& op) { declare_law_fields(op, false); });
  if (averages())
    on_demand<AveragedStrainEnergy>("solid.averaged_strain_energy", itself(),
                                    [&](auto& op) { op.structure = structure; });
  const double dx = structure->settings.spacing;
  if (controls())
    on_demand<HourglassEnergy>("solid.hourglass_energy", itself(),
                               [&](auto& op) { op.stiffness = structure->hourglass / (dx * dx); });
  else
    on_demand<NoHourglassEnergy>("solid.hourglass_energy");
  on_demand<NonAffine>("solid.non_affine", reference(), [&](auto& op) { op.structure = structure; });
}

}  // namespace shoal::solid
