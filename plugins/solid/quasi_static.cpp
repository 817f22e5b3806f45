// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "quasi_static.hpp"

#include "relaxation.hpp"
#include "stages.hpp"

namespace shoal::solid {
namespace {

constexpr std::uint64_t most_factorised = 200000, most_factorised_in_3d = 2500, most_bonded_in_3d = 20000;

MassKind mass_of(const QuasiStatic& physics, const Builder& b, BodyIndex body) {
  const std::string_view word = physics.mass->word;
  if (word == "stiffness") return MassKind::stiffness;
  if (word == "bonds") return MassKind::bonds;
  if (word == "lumped") return MassKind::lumped;
  const std::uint64_t n = b.body(body).n_particles;
  if (n < (b.dimensions() == 2 ? most_factorised : most_factorised_in_3d)) return MassKind::stiffness;
  return b.dimensions() == 3 && n < most_bonded_in_3d ? MassKind::bonds : MassKind::lumped;
}

}  // namespace

void QuasiStatic::build(const Builder& b) {
  declare_loop(b);
  if (loaded_at > b.end_time())
    throw CaseError(loaded_at.place() + ": loaded_at is behind the end of the run");
  auto rest = std::make_shared<Rest>();
  rest->tolerance = tolerance;
  rest->from = loaded_at;
  rest->iterations = static_cast<std::uint64_t>(iterations.value());
  rest->dt = b.end_time() / static_cast<double>(rest->iterations);
  std::vector<SolidBody> solids;
  for (const BodyIndex body : bodies.value()) {
    solids.emplace_back(b, *this, body).attach_initial();
    solids.back().attach_deformation();
    solids.back().attach_stress();
    solids.back().attach_forces();
    solids.back().attach_measures();
  }
  // The forces of all bodies are summed up before the first of them moves.
  for (const SolidBody& solid : solids)
    b.attach<OutOfBalance>("solid.out_of_balance", at_kick, solid.itself(), [&](auto& op) {
      op.rest = rest;
      op.first = &solid == &solids.front();
    });
  for (const SolidBody& solid : solids)
    b.attach<Relaxation>(
        "solid.relaxation", at_kick, solid.reference(),
        [&](auto& op) {
          op.structure = solid.structure;
          op.rest = rest;
          op.kind = mass_of(*this, b, solid.body);
          op.first = &solid == &solids.front();
        },
        SHOAL_OPERATOR_SERIAL);
}

}  // namespace shoal::solid
