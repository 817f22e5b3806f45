// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.outflow: particles that cross a plane leave. What they meet there is one of
//   pressure        p = p_b(x, t) in the zone, velocity extrapolated from the fluid: dv/dn = 0, v.n <= 0
//   non_reflecting  the same with p = p_b + rho0 c (U - <U>): U is the mean velocity out through the plane, <U> its mean over
//                   a time tau, d<U>/dt = (U - <U>)/tau. A wave of sound that comes has p' = rho0 c u' and passes
//                   (the outgoing characteristic of Lastiwka et al. 2009, for the mean over the section: vortices leave U
//                   alone), while slow changes meet p_b.
//   free            nothing: they are taken away, as below a waterfall or a jet
#pragma once

#include "inflow.hpp"

namespace shoal::fluid {

struct Outflow : Crossing<Outflow> {
  In<Vector> position{"position"};

  template <int D>
  void look(Exchange& exchange) {
    for (std::uint64_t k = 0; k < n_particles(); ++k) {
      const Particle<D> i{k, nullptr};
      const double s = zone->distance(position[i]);
      if (s >= 0.0 && open_boundary[i] != zone->name) continue;
      if (!zone->bounds(position[i])) continue;
      if (open_boundary[i] == 0) {
        open_boundary[i] = zone->name;
        *crossed += mass[i];
      } else if (open_boundary[i] == zone->name && s >= 0.0) {
        open_boundary[i] = 0;
        *crossed -= mass[i];
      }
      if (s < -zone->length) exchange.leave(k);
    }
  }
};

// What the outlet's operators share in non_reflecting.
struct Impedance {
  double mean = 0;    // <U>, m/s
  double time = 0;    // tau, s; 0: none
  double excess = 0;  // U - <U>, m/s
  double started = 0;
};

struct OutflowState : ZoneOperator<OutflowState> {
  In<Vector> position{"position"};
  In<Scalar> mass{"mass"};
  Out<Scalar> pressure{"pressure"};
  InOut<Scalar> density{"density"};
  InOut<Scalar> volume{"volume"};

  EquationOfState equation_of_state;
  Expression boundary_pressure;
  std::shared_ptr<const Impedance> impedance;

  void begin() {
    const double rho0 = equation_of_state.api->reference_density(equation_of_state.self);
    const double rho[2] = {rho0, rho0 * (1.0 + 1e-6)};
    double p[2];
    equation_of_state.api->pressure(equation_of_state.self, 2, rho, p);
    excess_ =
        impedance->time > 0.0 ? rho0 * std::sqrt((p[1] - p[0]) / (rho[1] - rho[0])) * impedance->excess : 0.0;
  }
  template <int D>
  void member(Particle<D> i) const {
    pressure[i] = boundary_pressure(D, &position[i][0], time() + 0.5 * dt()) + excess_;
    set_state(equation_of_state, pressure[i], mass[i], density[i], volume[i]);
  }

 private:
  double excess_ = 0;  // Pa
};

// Serial, as ZonePressure.
struct OutflowVelocity : Extrapolation<OutflowVelocity> {
  In<Vector> acceleration{"acceleration"};
  In<Vector> pressure_acceleration{"last_pressure_acceleration", unit("m/s2"),
                                   doc("Acceleration by pressure in the last acoustic step.")};
  InOut<Vector> place{"position", also_of_neighbours};
  InOut<Vector> velocity{"velocity", also_of_neighbours};
  Sum flux, weights;

  std::shared_ptr<Impedance> impedance;

  template <int D>
  void member(Particle<D> i) const {
    Vec<D> sum{};
    double weight = 0;
    for_each_fluid(i, [&](Particle<D> j, double w) {
      weight += w;
      sum += w * velocity[j];
    });
    const Vec<D> before = velocity[i] - dt() * (acceleration[i] + pressure_acceleration[i]);
    Vec<D> v = weight > 0.0 ? (1.0 / weight) * sum : before;
    const Vec<D> n = zone->direction<D>();
    const double inward = dot(v, n);
    flux.update(i, -weight * inward);
    weights.update(i, weight);
    if (inward > 0.0) v -= inward * n;
    place[i] += 0.5 * dt() * (v - velocity[i]);
    velocity[i] = v;
  }
  void end() {
    if (impedance->time == 0.0 || !(weights.result() > 0.0)) return;
    const double speed = flux.result() / weights.result();
    if (impedance->started == 0.0) impedance->mean = speed;
    impedance->started = 1;
    impedance->mean += -std::expm1(-dt() / impedance->time) * (speed - impedance->mean);
    impedance->excess = speed - impedance->mean;
  }
  void save(const shoal_stream& stream) const {
    check_host(stream.write(stream.context, impedance.get(), sizeof *impedance));
  }
  void load(const shoal_stream& stream) {
    check_host(stream.read(stream.context, impedance.get(), sizeof *impedance));
  }
};

struct OutflowPhysics final : PlaneParameters {
  Param<Choice> condition{"condition", nullptr,
                          "pressure: a given pressure behind the plane. non_reflecting: the same in the mean "
                          "over time, transparent to "
                          "sound. free: particles are taken away and nothing is given, as below a waterfall.",
                          one_of("pressure", "non_reflecting", "free"), default_to("pressure")};
  Param<Expression> pressure{"pressure", "Pa", "Pressure behind the plane as an expression of x, y, z and t.",
                             default_to("0"), example("\"1000*g*max(0, h - y)\"")};
  Param<double> averaging_time{"averaging_time",
                               "s",
                               "Of non_reflecting: time tau over which the mean outflow is taken. Several "
                               "times that of sound through the "
                               "domain, so that sound passes.",
                               positive,
                               optional,
                               example("1 s")};

  void build(const Builder& builder);
};

}  // namespace shoal::fluid
