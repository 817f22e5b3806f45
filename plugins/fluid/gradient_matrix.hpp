// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Correction of gradients (Bonet, Lok 1999), once in an advection step:
//   B_i = [ -sum_j V_j (W'/r) r_ij (x) r_ij ]^-1,     grad f_i = B_i sum_j V_j (f_j - f_i) grad W_ij
// exact for linear f, whatever the arrangement of the particles and at free surfaces and walls. The divergence of the
// velocity needs it: a drop that is stretched keeps its lattice, whose spacings become unequal, and the plain sum takes
// the pure strain for a compression (measured: the elliptic drop grows by 14 %).
// The force of pressure uses the matrices of both particles crosswise (Zhang, Zhu, Hu 2025),
//   dv_i/dt = -(1/rho_i) sum_j V_j (p_i B_j + p_j B_i) grad W_ij,
// which keeps momentum. Without it the deformed lattice bears shear like a soft solid, and a standing wave is 4 % too fast
// (measured with depth / dx = 50). Near free surfaces, where p is small and B large, it goes over to that of the lattice.
// Where neighbours do not span the space, as in a spray, B goes over to that of the lattice of the initial spacing.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"

namespace shoal::fluid {

// A field of operators in a variant that does without it.
struct NoField {
  template <class... Arguments>
  explicit NoField(Arguments&&...) {}
};
template <bool Corrected>
using MatrixIf = std::conditional_t<Corrected, In<Matrix>, NoField>;

struct GradientMoment : PairOperator<GradientMoment> {
  In<Scalar> volume{"volume"};
  Out<Matrix> matrix{"gradient_matrix", unit("1"), doc("Correction of gradients.")};

  auto pair(const auto& p) const { return outer((p.j(volume) * p.dW_over_r()) * p.r_ij(), p.r_ij()); }
  void particle(auto i, auto sum) const { matrix[i] = -1.0 * sum; }
};

// The walls' share; runs after GradientMoment.
struct WallGradientMoment : PairOperator<WallGradientMoment> {
  static constexpr bool skips_lonely = true;

  In<Scalar> wall_volume{"volume", neighbours_only};
  InOut<Matrix> matrix{"gradient_matrix", unit("1"), doc("Correction of gradients.")};

  auto pair(const auto& p) const { return outer((p.j(wall_volume) * p.dW_over_r()) * p.r_ij(), p.r_ij()); }
  void particle(auto i, auto sum) const { matrix[i] -= sum; }
};

// From the moments to their inverse.
struct GradientMatrix : ParticleOperator<GradientMatrix> {
  InOut<Matrix> matrix{"gradient_matrix", unit("1"), doc("Correction of gradients.")};

  Out<Matrix> pressure_matrix{"pressure_matrix", unit("1"), doc("Correction of the gradient of pressure.")};

  double slope = 1;  // of lattice_sums()

  template <int D>
  void particle(Particle<D> i) const {
    // 1 inside, 1/2 at a flat surface, 1/4 (2D) in a corner of the fluid
    const double filled = std::pow(std::max(0.0, determinant(matrix[i])), 1.0 / D);
    const double share = std::clamp((filled - 0.1) / 0.1, 0.0, 1.0);
    const Mat<D> lattice = (1.0 / slope) * identity<D>();
    matrix[i] = share > 0.0 ? share * inverse(matrix[i]) + (1.0 - share) * lattice : lattice;
    const double inside = std::clamp((filled - 0.7) / 0.2, 0.0, 1.0);
    pressure_matrix[i] = inside * matrix[i] + (1.0 - inside) * lattice;
  }
};

}  // namespace shoal::fluid
