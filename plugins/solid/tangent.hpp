// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Stiffness matrix of the discrete body, as linear elasticity that turns with the material,
//   u.K u = sum_i V_i [lambda (tr d_i)^2 + 2 mu sym(d_i) : sym(d_i) + alpha mu / dx^2 |r_i|^2],
//   d_i = R_i^T sum_j (u_j - u_i) (x) G_ij,   r_i = -sum_j (u_j - u_i) psi_ij,   F_i = R_i U_i.
// Positive definite where the body is held: what initial stress adds is left out. Where pressure is taken on a grid
// (volume_averaging.hpp) lambda is less by the bulk modulus K, and sum_c M_c K (sum_i V_i N_ci tr d_i / M_c)^2 is added.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "reference_weights.hpp"

namespace shoal::solid {

struct TangentInput {
  const ReferenceWeights& weights;
  std::uint64_t n;  // particles
  Stiffness stiffness;
  double spacing;  // m
  const double* volume;
  const double* F;           // deformation gradients
  const std::int64_t* held;  // bit a: axis a does not move; its rows and columns are left empty
};

// Entries of the lower half, several for one place.
std::vector<Eigen::Triplet<double>> tangent(int dimensions, const TangentInput& input);

}  // namespace shoal::solid
