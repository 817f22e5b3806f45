// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Open boundaries are planes with a zone of particles behind them, seen from the fluid (Lastiwka, Basa, Quinlan 2009;
// Tafuni et al. 2018):
//
//      zone     plane      fluid           s = (x - x_0).n,  n into the fluid
//   -L .......... 0 ...............        inlet:  particles of the zone cross s = 0 and become fluid
//                                          outlet: particles of the fluid cross s = 0 and belong to the zone
//
// The particles of a zone are of the same body and take part in all sums, so that the support of the fluid is whole; what
// would make them move is replaced by what the boundary prescribes. Their field `open_boundary` names their zone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::fluid {

// Also of the neighbours, in an operator that looks at single particles.
inline constexpr FieldOption also_of_neighbours{SHOAL_OF_NEIGHBOURS, 0};

inline constexpr const char* open_boundary_doc =
    "Zone of an open boundary that the particle is in; 0: fluid.";

struct Zone {
  std::int64_t name = 0;
  std::array<double, 3> origin{}, normal{};  // normal: into the fluid
  std::array<double, 3> lower{}, upper{};    // the plane is used within these bounds
  double length = 0;                         // L, m
  int dimensions = 2;

  template <int D>
  double distance(const Vec<D>& x) const {
    double s = 0;
    for (int a = 0; a < D; ++a) s += (x[a] - origin[index(a)]) * normal[index(a)];
    return s;
  }
  template <int D>
  bool bounds(const Vec<D>& x) const {
    for (int a = 0; a < D; ++a)
      if (x[a] < lower[index(a)] || x[a] > upper[index(a)]) return false;
    return true;
  }
  template <int D>
  Vec<D> direction() const {
    Vec<D> n{};
    for (int a = 0; a < D; ++a) n[a] = normal[index(a)];
    return n;
  }

 private:
  static std::size_t index(int axis) { return static_cast<std::size_t>(axis); }
};

using ZonePointer = std::shared_ptr<const Zone>;

// Where the plane is; the parameters that inlets and outlets share.
struct PlaneParameters : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies of fluid that pass through.",
                                       example("[water]")};
  Param<Vector3> at{"at", "m", "A point of the plane.", example("[0, 0]")};
  Param<Vector3> normal{"normal", "1", "Normal of the plane, into the fluid.", example("[1, 0]")};
  Param<Vector3> lower{"lower", "m", "Only what is beyond this corner belongs to the boundary.", optional,
                       example("[-1, 0]")};
  Param<Vector3> upper{"upper", "m", "Only what is before this corner belongs to the boundary.", optional,
                       example("[1, 0.41]")};
  Param<double> length{
      "length",
      "m",
      "Length of the zone behind the plane; without it the least that fills the supports, in "
      "whole spacings: 6 dx with the default smoothing kernel.",
      positive,
      optional,
      example("6*dx")};

 protected:
  ZonePointer zone(const Builder& b, BodyIndex body, bool has_length) const;
};

// An operator on the particles of one zone: `members` in ascending order, found whenever arrays have moved.
template <class Derived>
struct ZoneOperator : ParticleOperator<Derived> {
  In<Integer> open_boundary{"open_boundary", unit("1"), doc(open_boundary_doc), also_of_neighbours};

  ZonePointer zone;

  void bound() {
    members_.clear();
    for (std::uint64_t i = 0; i < this->n_particles(); ++i)
      if (open_boundary.data()[i] == zone->name) members_.push_back(i);
  }
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const auto& self = static_cast<const Derived&>(*this);
    auto i = std::lower_bound(members_.begin(), members_.end(), chunk.begin);
    for (; i != members_.end() && *i < chunk.end; ++i) self.member(Particle<D>{*i, chunk.partial});
  }

 private:
  std::vector<std::uint64_t> members_;
};

}  // namespace shoal::fluid
