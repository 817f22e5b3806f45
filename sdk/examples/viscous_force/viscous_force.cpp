// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plugin of one page: a viscous force that a case adds to a fluid of another plugin.
//
//   dv_i/dt += 2 nu sum_j V_j (v_i - v_j) W'(r) / (r + 0.01 h)                  (Morris, Fox, Zhu 1997)
//
// nu: kinematic viscosity, m2/s; V: volume, m3; W: smoothing kernel with smoothing length h, W' = dW/dr < 0.
// Stable for steps of at most 0.125 h^2 / nu.
#include <shoal/shoal.hpp>

namespace {
using namespace shoal;

struct ViscousForce : PairOperator<ViscousForce> {
  Param<double> nu{"viscosity", "m2/s", "Kinematic viscosity.", positive};
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};
  Accumulate<Vector> acceleration{"acceleration"};

  auto pair(const auto& p) const {
    return 2.0 * nu * p.j(volume) * p.dW() / (p.r() + 0.01 * p.h()) * (p.i(velocity) - p.j(velocity));
  }
  void particle(auto i, auto sum) const { acceleration[i] += sum; }
  double time_step(double h) const { return 0.125 * h * h / nu; }
};

}  // namespace

SHOAL_PLUGIN(example, "1.0.0") {
  summary("Viscosity, to show how a plugin is made.");
  add<ViscousForce>("example.viscous_force", "Viscous acceleration of a Newtonian fluid.",
                    "Morris, Fox, Zhu 1997, doi:10.1006/jcph.1997.5776");
}
