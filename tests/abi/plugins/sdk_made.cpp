// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plugin of the C++ layer: an operator that can be checked by hand, and one that throws where it must not.
#include <stdexcept>

#include "shoal/shoal.hpp"

namespace {
using namespace shoal;

// total_i = factor dt sum_j weight_j
struct Total : PairOperator<Total> {
  Param<double> factor{"factor", "1", "What the sum is multiplied with."};
  In<Scalar> weight{"weight", unit("1"), doc("Of a particle.")};
  Out<Scalar> total{"total", unit("s"), doc("Of the neighbours.")};

  auto pair(const auto& p) const { return p.j(weight); }
  void particle(auto i, auto sum) const { total[i] = factor * dt() * sum; }
};

struct Throws : ParticleOperator<Throws> {
  Param<Choice> what{"what", nullptr, "How it fails.", one_of("error", "case", "physics", "number")};
  Out<Scalar> total{"total", unit("s"), doc("Never written.")};

  void particle(auto) const {
    if (what->word == "case") throw CaseError("the case asks too much");
    if (what->word == "physics") throw PhysicsFailed("the particle is gone");
    if (what->word == "number") throw 7;
    throw std::runtime_error("no memory for a thought");
  }
};

}  // namespace

SHOAL_PLUGIN(sdk_made, "1.0.0") {
  summary("A plugin of the tests.");
  add<Total>("sdk_made.total", "A sum over neighbours.");
  add<Throws>("sdk_made.throws", "Fails in run.");
}
