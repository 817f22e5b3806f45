// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Deformation gradient and hourglass residual,
//   F_i = sum_j (x_j - x_i) (x) G_ij,
//   q_i = alpha mu / dx^2 r_i,   r_i = -sum_j (x_j - x_i) psi_ij,
// the second being the derivative of the energy 1/2 alpha mu |r_i|^2 / dx^2 of modes that F does not see. It is a
// function of the particles' positions alone, so energy is conserved, and it turns with the body, so angular momentum
// is too. F is exact for linear motions on any arrangement of particles. Weights: reference_weights.hpp.
#pragma once

#include <algorithm>

#include "stencils.hpp"
#include "structure.hpp"

namespace shoal::solid {

template <bool Hourglass>
struct HourglassStress {
  Out<Vector> hourglass{"hourglass_stress", unit("N/m3"),
                        doc("Resistance to modes that alternate between particles."), derived};
};
template <>
struct HourglassStress<false> {};

template <bool Hourglass>
struct DeformationGradientOf : WeightBuilder, HourglassStress<Hourglass> {
  In<Vector> position{"position"};
  Out<Matrix> F{"deformation_gradient", derived};

  void begin() {
    build_weights();
    stiffness_ = structure->hourglass / (structure->settings.spacing * structure->settings.spacing);
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const double* x = position.of_neighbours(0);
    double *gradient = F.data(), *q = nullptr;
    if constexpr (Hourglass) q = this->hourglass.data();
    const ReferenceWeights& weights = structure->weights;
    weights.deform<D, Hourglass>(chunk.begin, chunk.end, x, stiffness_, gradient, q);
    weights.correct<D, Hourglass>(chunk.begin, chunk.end, stiffness_, gradient, q);
  }

 private:
  double stiffness_ = 0;  // N/m4
};
using DeformationGradient = DeformationGradientOf<true>;

}  // namespace shoal::solid
