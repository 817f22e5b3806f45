// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Consistency of forces on disordered particles.
//
// G is exact for linear motions on any arrangement, but its transpose need not be: a uniform stress P gives particle i
// the force V_i P r_i with r_i = sum_j (G_ij - V_j / V_i G_ji), which on a lattice vanishes inside the body and on
// disordered particles does not. The body then relaxes into a non-affine motion and is too soft (the oscillating plate
// with 8 particles across and positions off by 0.2 spacings: period 57 % too long). It is the integration constraint of
// Galerkin methods with nodal integration (Chen, Hillman, Rueter 2013), which they mend in the test functions and so
// lose symmetry. Here the weights themselves are changed, by the least change that mends it:
//   minimise sum_ij V_i / w_ij |dG_ij|^2  such that  sum_j dG_ij (x) p_ij = 0  (what was exact stays exact)
//   and r_i = 0 inside, its tangential part = 0 within the support of the surface.
// The solution is dG_ij = w_ij [l_j - l_i - L_i p_ij], L_i being the fit of the multipliers l at i; l solves a symmetric
// system on the graph of neighbours, here by conjugate gradients. Transpose, conservation and energy stay as they are.
#pragma once

#include "reference_weights.hpp"

namespace shoal::solid {

// Changes the gradients in `forward` (stride D + 1, rows at `offsets`). `normal` and `distance` are those of the body's
// surface. Nothing is done where the residual is small from the start, as on a lattice.
template <int D>
ForceConsistency make_consistent(const ReferenceSettings& settings, const shoal_neighbours& list,
                                 const ReferenceGeometry& geometry, const std::vector<std::uint64_t>& offsets,
                                 double* forward);

}  // namespace shoal::solid
