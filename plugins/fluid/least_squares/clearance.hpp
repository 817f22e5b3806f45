// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// No particle goes through a wall. Fluid particles move with the flow, whose velocity normal to the wall vanishes there,
// but only to the accuracy of the fit: in a corner where a sliding wall leaves one at rest, velocity jumps and particles
// are carried through. The shift of a particle is therefore chosen so that at its end it keeps a distance d0 from each
// wall,
//   n_j . dr_i >= d0 - d_ij - n_j . [3/2 dt (v_i - v_j) + dr_i^(n) / 2],     d_ij = n_j . (x_i - s_j)
// for those wall particles j whose point of the surface s_j is within a spacing of the particle's foot; least squares over
// them, so that both walls of a corner are heeded. Fields are carried along the shift as always (motion.hpp).
#pragma once

#include "shoal/pair_operator.hpp"

#include "fit.hpp"
#include "motion.hpp"

namespace shoal::fluid::least_squares {

struct Clearance : PairOperator<Clearance> {
  static constexpr bool skips_lonely = true;
  template <int D>
  using Kernel = Weight<D>;
  static constexpr double least = 0.3;  // d0 over dx
  static constexpr double deepest =
      0.75;  // beyond the surface by more than this share of dx: it is another wall's side
  static constexpr double weak =
      0.25;  // of the least squares, where the surface is hardly that of one of the walls
  static constexpr double largest = 0.25;  // shift over dx

  In<Vector> velocity_mid{"velocity_mid", unit("m/s"), doc(v_mid_doc), derived, own_only};
  In<Vector> shift{"shift", unit("m"), doc(shift_doc), own_only};
  In<Vector> wall_velocity{"velocity", neighbours_only};
  In<Vector> normal{"normal", neighbours_only};
  In<Scalar> signed_distance{"signed_distance", neighbours_only};
  InOut<Vector> next_shift{"next_shift", unit("m"), doc(shift_doc), derived};

  auto pair(const auto& p) const {
    const auto n = p.j(normal);
    const auto from_surface = p.r_ij() + p.j(signed_distance) * n;
    const auto d = dot(n, from_surface);
    const double dx = spacing();
    const auto aside = (squared_norm(from_surface) - d * d) * (1.0 / (dx * dx));
    const auto moves =
        1.5 * dt() * (p.i(velocity_mid) - p.j(wall_velocity)) + 0.5 * p.i(shift) + p.i(next_shift);
    const auto missing = least * dx - d - dot(n, moves);
    const auto near = max(0.0, 1.0 - aside);
    using R = decltype(d * 1.0);
    const auto weight = select(min(missing, d + deepest * dx) > 0.0, near * near, R(0.0));
    return sums(outer(weight * n, n), (weight * missing) * n);
  }
  template <int D>
  void particle(Particle<D> i, Mat<D> normals, Vec<D> missing) const {
    for (int a = 0; a < D; ++a) normals(a, a) += weak;
    next_shift[i] += limited(inverse(normals) * missing, largest * spacing());
  }
};

}  // namespace shoal::fluid::least_squares
