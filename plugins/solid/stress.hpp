// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// First Piola-Kirchhoff stress from the material's stress law, block by block.
#pragma once

#include <array>

#include "shoal/declared_fields.hpp"
#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

// What the law is told of particles that stand one after the other; the caller fills in what it wants to know.
inline shoal_stress_block stress_block(const Structure& structure, std::uint64_t n, const double* F,
                                       double* const* fields) {
  shoal_stress_block block{};
  block.size = sizeof block;
  block.kinematics = structure.kinematics;
  block.n = n;
  block.deformation_gradient = F;
  block.fields = fields;
  return block;
}

struct Stress : ParticleOperator<Stress> {
  In<Matrix> F{"deformation_gradient"};
  Out<Matrix> P{"piola_stress", unit("Pa"), doc("First Piola-Kirchhoff stress."), derived};
  DeclaredFields law_fields{*this};
  SharedStructure structure;
  bool trial = false;  // looks at the stress without making the step

  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto components = static_cast<std::uint64_t>(dimensions() * dimensions());
    std::array<double*, DeclaredFields::most> fields;
    law_fields.at(begin, fields.data());
    shoal_stress_block block =
        stress_block(*structure, end - begin, F.data() + begin * components, fields.data());
    if (!trial) block.flags = SHOAL_STRESS_UPDATES_STATE;
    block.time = time() + 0.5 * dt();
    block.dt = dt();
    block.stress = P.data() + begin * components;
    check_host(structure->law.api->stress(structure->law.self, &block));
  }
};

// The fields that the law keeps, of the undeformed body.
struct InitialState : ParticleOperator<InitialState> {
  In<Vector> position{"position"};
  In<Scalar> distance{"signed_distance"};
  InOut<Scalar> volume{"volume"};
  Out<Scalar> mass{"mass"};
  DeclaredFields law_fields{*this};
  SharedStructure structure;

  void begin() {
    const HeldSurface held = structure->held_surface(dimensions(), n_particles(), position.data());
    if (!held.empty()) cut_volumes(held, dimensions(), position.data(), volume.data());
    if (structure->end_correction)
      correct_ends(n_particles(), distance.data(), structure->settings.spacing, volume.data());
  }

  void block(std::uint64_t begin, std::uint64_t end) const {
    std::array<double*, DeclaredFields::most> fields;
    law_fields.at(begin, fields.data());
    for (std::uint64_t i = begin; i < end; ++i)
      mass.data()[i] = structure->constants.density * volume.data()[i];
    if (structure->law.api->initialise != nullptr)
      check_host(structure->law.api->initialise(
          structure->law.self, structure->kinematics, end - begin,
          position.data() + begin * static_cast<std::uint64_t>(dimensions()), fields.data()));
  }
};

}  // namespace shoal::solid
