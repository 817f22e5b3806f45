// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Particle shifting in flows with a free surface (Lind et al. 2012; Khayyer, Gotoh, Shimizu 2017: optimised particle
// shifting). Once in an advection step particles move by
//   dr_i = -C h^2 sum_j V_j grad W_ij,    |dr_i| <= 0.1 dx
// which spreads them evenly. At a free surface the sum points out of the fluid, so there only its part along the surface
// counts:
//   filled_i = -(1/D) sum_j V_j r_ij . grad W_ij         1 inside, 1/2 at a flat surface (divergence of position / D)
//   n_i      = -grad filled / |grad filled|              out of the fluid
//   dr_i    := (1 - n_i n_i) dr_i                        where filled_i or that of a neighbour is below 0.8
// and particles in spray, filled_i < 0.35, are left alone. Walls count as fluid. Velocities are not remapped: with a free
// surface the shift is small against the flow.
#pragma once

#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

namespace shoal::fluid {

inline constexpr const char *surface_shift_doc = "Shift of the particle in this advection step.",
                            *filled_doc = "Share of the surroundings that fluid and walls fill.";

struct Crowding : PairOperator<Crowding> {
  In<Scalar> volume{"volume"};
  Out<Vector> shift{"transport_shift", unit("m"), doc(surface_shift_doc), derived};
  Out<Scalar> filled{"filled", unit("1"), doc(filled_doc), derived};

  double strength = 0.5;
  double gradient_scale = 1;  // 1 / slope of lattice_sums()

  auto pair(const auto& p) const {
    const auto weight = p.j(volume) * p.dW_over_r();
    return sums(weight * p.r_ij(), weight * p.r() * p.r());
  }
  void particle(auto i, auto gradient, double divergence) const {
    shift[i] = (-strength * smoothing_length() * smoothing_length()) * gradient;
    filled[i] = (-gradient_scale / i.dimensions) * divergence;
  }
};

// The walls' share; runs after Crowding.
struct WallCrowding : PairOperator<WallCrowding> {
  static constexpr bool skips_lonely = true;

  In<Scalar> wall_volume{"volume", neighbours_only};
  InOut<Vector> shift{"transport_shift", unit("m"), doc(surface_shift_doc), derived};
  InOut<Scalar> filled{"filled", unit("1"), doc(filled_doc), derived};

  double strength = 0.5;
  double gradient_scale = 1;

  auto pair(const auto& p) const {
    const auto weight = p.j(wall_volume) * p.dW_over_r();
    return sums(weight * p.r_ij(), weight * p.r() * p.r());
  }
  void particle(auto i, auto gradient, double divergence) const {
    shift[i] -= (strength * smoothing_length() * smoothing_length()) * gradient;
    filled[i] -= (gradient_scale / i.dimensions) * divergence;
  }
};

// Takes the part across the surface off.
struct AlongSurface : PairOperator<AlongSurface> {
  static constexpr double inside = 0.8, spray = 0.35;

  In<Scalar> volume{"volume"};
  In<Scalar> filled{"filled", unit("1"), doc(filled_doc), derived};
  InOut<Vector> shift{"transport_shift", unit("m"), doc(surface_shift_doc), derived};

  auto pair(const auto& p) const {
    const auto beyond = p.j(filled);
    const auto low = max(0.0, inside - beyond);
    return sums((p.j(volume) * p.dW_over_r() * (beyond - p.i(filled))) * p.r_ij(), low);
  }
  void particle(auto i, auto gradient, double low_neighbours) const {
    if (filled[i] < spray) {
      shift[i] = 0.0 * shift[i];
    } else if (filled[i] < inside || low_neighbours > 0.0) {
      const double square = squared_norm(gradient);
      if (square > 0.0) shift[i] -= (dot(shift[i], gradient) / square) * gradient;
    }
  }
};

}  // namespace shoal::fluid
