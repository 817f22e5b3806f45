// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "constraints.hpp"

#include "held_surface.hpp"
#include "stages.hpp"

namespace shoal::solid {

void PrescribedMotion::begin() {
  if (!region.looked()) {
    region.look(dimensions(), n_particles(), reference_position.data());
    for (std::size_t k = 0; k < 3; ++k) {
      value_[k].assign(motion == Motion::displacement ? n_particles() : 0, 0.0);
      rate_[k].assign(motion != Motion::held ? n_particles() : 0, 0.0);
    }
  }
  if (motion == Motion::held) return;
  const double end = time() + (half_step ? 0.5 : 1.0) * dt();
  const double delta = dt() > 0.0 ? 0.5 * dt() : 1e-6;
  std::vector<double> before(n_particles());
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions()); ++k) {
    if (!axes[k]) continue;
    const Expression& expression = given.component[k];
    if (motion == Motion::velocity) {
      region.evaluate(expression, dimensions(), end, rate_[k]);
      continue;
    }
    region.evaluate(expression, dimensions(), end, value_[k]);
    if (half_step) continue;
    region.evaluate(expression, dimensions(), end + delta, rate_[k]);
    region.evaluate(expression, dimensions(), end - delta, before);
    for (const std::uint64_t i : region.particles()) rate_[k][i] = (rate_[k][i] - before[i]) / (2.0 * delta);
  }
}

namespace {

std::array<bool, 3> axes_of(const Param<std::vector<Choice>>& axes, int dimensions) {
  if (!axes.is_set()) return {true, true, true};
  std::array<bool, 3> chosen{};
  for (const Choice& axis : axes.value()) {
    if (axis == "z" && dimensions == 2)
      throw CaseError(axes.place() + ": there is no axis z in two dimensions");
    chosen[static_cast<std::size_t>(axis.word[0] - 'x')] = true;
  }
  return chosen;
}

void attach_on_demand(const Builder& b, BodyIndex body, const Region& region,
                      const std::array<bool, 3>& axes) {
  b.attach<ReactionForce>(
      "solid.reaction_force", {SHOAL_SAMPLE, "reactions"}, b.target(body),
      [&](auto& op) {
        op.region = region;
        op.axes = axes;
      },
      SHOAL_OPERATOR_ON_DEMAND);
  b.attach<HeldAxes>(
      "solid.held_axes", {SHOAL_INITIAL, "constraints"}, b.target(body),
      [&](auto& op) {
        op.region = region;
        op.axes = axes;
      },
      SHOAL_OPERATOR_ON_DEMAND);
}

}  // namespace

void Clamp::build(const Builder& b) {
  declare_loop(b);
  if (built_into.is_set() && (where.is_set() || within.is_set() || axes.is_set()))
    throw CaseError(
        built_into.place() +
        ": built_into holds all that is in its shape, along all axes; leave out where, within and "
        "axes, or make another solid.clamp of them");
  for (const BodyIndex body : bodies.value()) {
    const auto region = [&] {
      Region chosen = region_of(where, built_into.is_set() ? built_into : within, b.dimensions());
      if (built_into.is_set()) chosen.margin = HeldSurface::margin(b.body(body).spacing);
      return chosen;
    };
    const HeldRegions held = held_regions(b, body);
    if (built_into.is_set()) held->push_back(region());
    const auto setup = [&](PrescribedMotion& op) {
      op.kept = held;
      op.region.region = region();
      op.axes = axes_of(axes, b.dimensions());
    };
    b.attach<PrescribedMotion>("solid.clamp", {SHOAL_INITIAL, "constraints"}, b.target(body), setup);
    b.attach<PrescribedMotion>("solid.clamp", at_constraints, b.target(body), setup);
    attach_on_demand(b, body, region(), axes_of(axes, b.dimensions()));
  }
}

void PrescribedMotionPhysics::build(const Builder& b) {
  declare_loop(b);
  if (displacement.is_set() == velocity.is_set())
    throw CaseError(
        "solid.prescribed_motion needs either a displacement or a velocity, e.g. displacement: [\"0.1*t\", "
        "0]");
  for (const BodyIndex body : bodies.value()) {
    const auto setup = [&](PrescribedMotion& op) {
      op.region.region = region_of(where, within, b.dimensions());
      op.axes = axes_of(axes, b.dimensions());
      op.motion = displacement.is_set() ? Motion::displacement : Motion::velocity;
      op.given = displacement.is_set() ? displacement.value() : velocity.value();
    };
    b.attach<PrescribedMotion>("solid.prescribed_motion", {SHOAL_INITIAL, "constraints"}, b.target(body),
                               setup);
    if (displacement.is_set())
      b.attach<PrescribedMotion>("solid.prescribed_motion.half", at_half_motion, b.target(body),
                                 [&](auto& op) {
                                   setup(op);
                                   op.half_step = true;
                                 });
    b.attach<PrescribedMotion>("solid.prescribed_motion", at_constraints, b.target(body), setup);
    attach_on_demand(b, body, region_of(where, within, b.dimensions()), axes_of(axes, b.dimensions()));
  }
}

}  // namespace shoal::solid
