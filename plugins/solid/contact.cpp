// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "contact_scale.hpp"
#include "stages.hpp"
#include "wave_modulus.hpp"

namespace shoal::solid {
namespace {

// Names of fields, which operators borrow for as long as the program runs.
const char* keep(const std::string& name) {
  static std::set<std::string> names;
  return names.insert(name).first->c_str();
}

// One body that feels another, or itself.
struct Touch {
  const Builder& b;
  const Contact& physics;
  BodyIndex own, other;

  bool itself() const { return own.value == other.value; }
  std::string own_name() const { return b.body(own).name; }
  std::string other_name() const { return b.body(other).name; }
  const char* overlap(bool of_other) const {
    return keep("contact_overlap_with_" + (of_other ? own_name() : other_name()));
  }
  const char* normal(bool of_other) const {
    return keep("contact_normal_with_" + (of_other ? own_name() : other_name()));
  }
  Target target() const {
    Target t = b.target(own, {other});
    t.smoothing_kernel = SmoothingKernel::wendland_c2;
    t.smoothing_length = 1.3 * std::max(b.body(own).spacing, b.body(other).spacing);
    t.cutoff = 2.0 * t.smoothing_length;
    return t;
  }
  ContactScale scale() const {
    return contact_scale(b.dimensions(), target(), b.body(own).spacing, b.body(other).spacing);
  }
  double modulus() const { return stiffest() / scale().stiffness; }
  double pressure_per_overlap() const {  // Pa/m
    return stiffest() / std::min(b.body(own).spacing, b.body(other).spacing);
  }
  void attach_overlap() const { itself() ? overlaps<FarPair>() : overlaps<AnyPair>(); }
  void attach_force() const { itself() ? forces<FarPair>() : forces<AnyPair>(); }

 private:
  double stiffest() const {
    return physics.stiffness * std::min(wave_modulus(b, own), wave_modulus(b, other));
  }
  void set_pairs(AnyPair&) const {}
  void set_pairs(FarPair& pairs) const { pairs.distance = physics.self_distance * b.body(own).spacing; }

  template <class Pairs>
  void overlaps() const {
    const double touching = scale().colour_a;
    b.attach<ContactOverlap<Pairs>>("solid.contact_overlap", at_forces, target(), [&](auto& op) {
      op.overlap.rename(overlap(false));
      op.touching = touching;
      set_pairs(op.pairs_in_contact);
    });
    if (physics.friction == 0.0) return;
    b.attach<ContactNormal<Pairs>>("solid.contact_normal", at_forces, target(), [&](auto& op) {
      op.normal.rename(normal(false));
      set_pairs(op.pairs_in_contact);
    });
  }
  template <class Pairs>
  void forces() const {
    const auto setup = [&](auto& op) {
      op.own_overlap.rename(overlap(false));
      op.other_overlap.rename(overlap(true));
      op.K = modulus();
      set_pairs(op.pairs_in_contact);
    };
    b.attach<ContactForce<Pairs>>("solid.contact_force", at_forces, target(), [&](auto& op) {
      setup(op);
      op.added = added_stiffness(b, own);
      *op.added += 2.0 * pressure_per_overlap() / b.body(own).spacing;
    });
    if (physics.friction == 0.0) return;
    b.attach<ContactFriction<Pairs>>("solid.contact_friction", at_forces, target(), [&](auto& op) {
      setup(op);
      op.own_normal.rename(normal(false));
      op.other_normal.rename(normal(true));
      op.friction = physics.friction;
    });
  }
};

}  // namespace

void Contact::build(const Builder& b) {
  const auto& list = bodies.value();
  if (list.size() < 2 && self->empty())
    throw CaseError(bodies.place() +
                    ": solid.contact needs two bodies that may touch, or one that may touch itself, "
                    "e.g. {bodies: [tube], self: [tube]}");
  std::set<std::uint32_t> seen;
  for (const BodyIndex body : list)
    if (!seen.insert(body.value).second)
      throw CaseError(bodies.place() + ": solid.contact names body '" + b.body(body).name + "' twice");
  std::set<std::uint32_t> seen_self;
  for (const BodyIndex body : self.value()) {
    if (!seen_self.insert(body.value).second)
      throw CaseError(self.place() + ": solid.contact names body '" + b.body(body).name + "' twice");
    if (std::none_of(list.begin(), list.end(), [&](BodyIndex other) { return other.value == body.value; }))
      throw CaseError(self.place() + ": body '" + b.body(body).name + "' is not among the bodies in contact");
  }
  declare_loop(b);
  b.renew_neighbours_in("structure");
  std::vector<Touch> touches;
  for (const BodyIndex own : list)
    for (const BodyIndex other : list)
      if (own.value != other.value) touches.push_back({b, *this, own, other});
  for (const BodyIndex body : self.value()) touches.push_back({b, *this, body, body});
  // A force needs the overlaps of both sides.
  for (const Touch& touch : touches) touch.attach_overlap();
  for (const Touch& touch : touches) touch.attach_force();
}

}  // namespace shoal::solid
