// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.inflow: a given velocity on a plane, v(x, t), uniform along the normal within the zone. The particles of the zone
// move with it, in rows along the normal; one that crosses the plane becomes fluid, and a copy of it joins the zone one
// length of the zone behind, so that the rows never end (Lastiwka et al. 2009). The mass that enters is that of whole
// particles: over time, that of the profile sampled at the rows. The pressure is extrapolated from the fluid: an inlet
// reflects sound as a moving piston does.
#pragma once

#include "prescribed.hpp"

namespace shoal::fluid {

// Mass that has crossed the plane so far, kg; kept by the operator that sees particles cross.
using MassPointer = std::shared_ptr<double>;

inline void keep(const shoal_stream& stream, const double& mass) {
  check_host(stream.write(stream.context, &mass, sizeof mass));
}
inline void restore(const shoal_stream& stream, double& mass) {
  check_host(stream.read(stream.context, &mass, sizeof mass));
}

// At the start: which particles are in the zone.
struct FillZone : ParticleOperator<FillZone> {
  In<Vector> position{"position"};
  InOut<Integer> open_boundary{"open_boundary", unit("1"), doc(open_boundary_doc)};

  ZonePointer zone;

  void particle(auto i) const {
    const double s = zone->distance(position[i]);
    if (s < 0.0 && s >= -zone->length && zone->bounds(position[i])) open_boundary[i] = zone->name;
  }
};

// What sees particles cross the plane: Derived::look<D> says which leave and join.
template <class Derived>
struct Crossing : ParticleOperator<Derived> {
  InOut<Integer> open_boundary{"open_boundary", unit("1"), doc(open_boundary_doc)};
  In<Scalar> mass{"mass"};

  ZonePointer zone;
  MassPointer crossed;

  void exchange(Exchange& exchange) {
    Derived& derived = static_cast<Derived&>(*this);
    this->dimensions() == 2 ? derived.template look<2>(exchange) : derived.template look<3>(exchange);
  }
  void save(const shoal_stream& stream) const { keep(stream, *crossed); }
  void load(const shoal_stream& stream) { restore(stream, *crossed); }
};

struct Inflow : Crossing<Inflow> {
  InOut<Vector> position{"position"};

  void fill(std::uint64_t begin, std::uint64_t end) {
    dimensions() == 2 ? set_back<2>(begin, end) : set_back<3>(begin, end);
  }
  template <int D>
  void look(Exchange& exchange) {
    for (std::uint64_t k = 0; k < n_particles(); ++k) {
      const Particle<D> i{k, nullptr};
      const double s = zone->distance(position[i]);
      if (open_boundary[i] == zone->name && s >= 0.0) {
        open_boundary[i] = 0;
        *crossed += mass[i];
        exchange.join(k);
      } else if (s < -zone->length && s > -2.0 * zone->length && zone->bounds(position[i])) {
        // Driven out by the fluid
        if (open_boundary[i] == 0) *crossed -= mass[i];
        exchange.leave(k);
      }
    }
  }

 private:
  template <int D>
  void set_back(std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t k = begin; k < end; ++k) {
      const Particle<D> i{k, nullptr};
      position[i] -= zone->length * zone->direction<D>();
      open_boundary[i] = zone->name;
    }
  }
};

// v(x, t) at the end of the acoustic step, and the place that belongs to it: Kick has moved the particle with another.
struct InflowVelocity : ZoneOperator<InflowVelocity> {
  InOut<Vector> position{"position"};
  InOut<Vector> velocity{"velocity"};

  VectorExpression profile;

  template <int D>
  void member(Particle<D> i) const {
    const Vec<D> x = position[i] - zone->distance(position[i]) * zone->direction<D>();
    Vec<D> v;
    for (int a = 0; a < D; ++a)
      v[a] = profile.component[static_cast<std::size_t>(a)](D, &x[0], time() + dt());
    position[i] += 0.5 * dt() * (v - velocity[i]);
    velocity[i] = v;
  }
};

// For probes: each particle has an equal share of the mass that has crossed the plane, so that its sum is that mass.
template <class Name>
struct CrossedMass : ParticleOperator<CrossedMass<Name>> {
  Accumulate<Scalar> share{Name::field, unit("kg"), doc(Name::doc_text), derived};

  MassPointer crossed;

  void particle(auto i) const { share[i] += *crossed / static_cast<double>(this->n_particles()); }
};

struct EnteredMass {
  static constexpr const char *field = "entered_mass",
                              *doc_text = "A particle's equal share of the mass that has entered so far.";
};
struct LeftMass {
  static constexpr const char *field = "left_mass",
                              *doc_text = "A particle's equal share of the mass that has left so far.";
};

struct InflowPhysics final : PlaneParameters {
  Param<VectorExpression> velocity{"velocity", "m/s",
                                   "Velocity on the plane as expressions of x, y, z and t. The body reaches "
                                   "one length of the zone behind the "
                                   "plane, in whole spacings.",
                                   example("[\"4*U*y*(H - y)/H^2\", 0]")};

  void build(const Builder& builder);
};

}  // namespace shoal::fluid
