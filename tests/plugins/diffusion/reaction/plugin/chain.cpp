// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A third party's plugin with a reaction model of its own: the chain of decays a -> b -> c.
#include "shoal/plugin.hpp"
#include "shoal/reaction_model.hpp"

namespace {

struct Chain final : shoal::ReactionModel<Chain, 3> {
  shoal::Param<double> first{"first", "1/s", "Rate of a -> b.", shoal::positive};
  shoal::Param<double> second{"second", "1/s", "Rate of b -> c.", shoal::positive};

  std::vector<shoal::ReactionVariable> variables() const {
    return {{"a", "mol/m3", "Concentration of a.", 1.0, 1e-4},
            {"b", "mol/m3", "Concentration of b.", 0.0, 1e-4},
            {"c", "mol/m3", "Concentration of c.", 0.0, 0.0}};
  }
  double largest_step() const { return 0.1 / std::max(first.value(), second.value()); }

  template <shoal::Real R>
  shoal::Rates<R, 3> rates(const std::array<R, 3>& y) const {
    return {{R(0.0), R(first) * y[0], R(second) * y[1]}, {R(first), R(second), R(0.0)}};
  }
};

// A material that is no reaction.
struct Stone final : shoal::Material {};

}  // namespace

SHOAL_PLUGIN(chain, "1.0.0") {
  summary("A reaction model of a third party.");
  add<Chain>("chain.decay", "Chain of two decays.");
  add<Stone>("chain.stone", "Does not react.");
}
