// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What solids in motion (total_lagrangian.hpp) and at rest (quasi_static.hpp) have in common: the parameters of the
// discretisation, and the operators for stress, internal force, loads, and what outputs ask for.
#pragma once

#include "shoal/physics.hpp"
#include "structure.hpp"

namespace shoal::solid {

struct SolidPhysics : Physics {
  Param<std::vector<BodyIndex>> bodies{
      "bodies", nullptr, "Solid bodies, each with a material that has a stress law.", example("[beam]")};
  Param<Choice> plane{
      "plane", nullptr,
      "In two dimensions: whether the body is thick (plane strain) or a thin sheet (plane stress).",
      one_of("strain", "stress"), default_to("strain")};
  Param<Choice> gradient{
      "gradient", nullptr,
      "quadratic: least-squares fit of second order. linear: the correction matrix of Bonet and Lok, which "
      "loses "
      "bending stress at surfaces (Turek and Hron's CSM1 at 8 particles across: 7 % against 1 %).",
      one_of("quadratic", "linear"), default_to("quadratic")};
  Param<double> support{"support", "1",
                        "Radius of the reference neighbourhood over the distance of the particles.",
                        between(1.8, 4.0), default_to(2.3)};
  Param<double> regularisation{
      "regularisation", "1",
      "Of the quadratic terms of the fit: more allows larger steps on disordered particles, "
      "less is more accurate.",
      non_negative, default_to(0.01)};
  Param<bool> consistent{
      "consistent", nullptr,
      "Whether the weights of disordered particles are changed so that a uniform stress exerts no "
      "force inside the body; a lattice needs no change.",
      default_to(true)};
  Param<bool> end_correction{
      "end_correction", nullptr,
      "Whether the two outermost layers of particles weigh 25/24 and 23/24 of their volume, the end "
      "correction of the "
      "midpoint rule: thin bodies of a lattice bend more accurately (12 particles across: 0.7 %).",
      default_to(false)};
  Param<double> hourglass{
      "hourglass", "1",
      "Strength of the control of modes that alternate between particles, over the shear modulus; 0: none.",
      non_negative, default_to(4.0)};
  Param<Choice> average_volume{"average_volume", nullptr,
                               "Whether the volumetric part of the energy takes volume ratios on a grid of "
                               "twice the spacing, which keeps the "
                               "pressure of nearly incompressible materials smooth; automatic: where the "
                               "bulk modulus is more than ten times the "
                               "shear modulus (Poisson's ratio above 0.452).",
                               one_of("automatic", "always", "never"), default_to("automatic")};
};

// One body of such a physics.
struct SolidBody {
  SolidBody(const Builder& builder, const SolidPhysics& physics, BodyIndex body);

  Target itself() const { return b.target(body); }
  Target reference() const { return reference_target(b, body, *structure); }
  template <class Op>
  void declare_law_fields(Op& op, bool writes) const {
    std::uint32_t n = 0;
    const shoal_access* fields = structure->law.api->fields(structure->law.self, structure->kinematics, &n);
    op.law_fields.declare(n, fields, writes);
    op.structure = structure;
  }

  void attach_initial() const;
  // The stages deformation, stress and forces, with `in_between` called behind the stress of the law.
  void attach_deformation() const;
  void attach_stress() const;
  void attach_forces() const;
  // What outputs and probes ask for: each runs only if somebody does.
  void attach_measures() const;

  const Builder& b;
  const SolidPhysics& physics;
  BodyIndex body;
  SharedStructure structure;

 private:
  template <class Op, class Setup>
  void on_demand(const char* name, Target target, Setup&& setup) const;
  template <class Op>
  void on_demand(const char* name) const;
  bool averages() const;
  bool controls() const { return structure->hourglass > 0.0; }
  void attach_averaging(At at, const struct AveragingFields& names, std::uint32_t flags) const;
  template <bool Hourglass>
  void attach_current_state() const;
};

}  // namespace shoal::solid
