// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces that several stress laws share. F deformation gradient, J = det F, C = F^T F.
#pragma once

#include <cmath>

#include "shoal/pack_math.hpp"
#include "shoal/vec.hpp"

namespace shoal::solid {

using Tensor = Mat<3, Pack>;

// J and F^-T from the cofactors.
struct Inverted {
  Pack J;
  Tensor inverse_transpose;
};
inline Inverted invert(const Tensor& F) {
  Tensor cofactors{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactors(r, c) = F(r1, c1) * F(r2, c2) - F(r1, c2) * F(r2, c1);
    }
  const Pack J = F(0, 0) * cofactors(0, 0) + F(0, 1) * cofactors(0, 1) + F(0, 2) * cofactors(0, 2);
  return {J, (1.0 / J) * cofactors};
}

// Symmetric: six products of columns, not nine.
inline Tensor right_cauchy_green(const Tensor& F) {
  Tensor C;
  for (int r = 0; r < 3; ++r)
    for (int c = r; c < 3; ++c) C(r, c) = C(c, r) = F(0, r) * F(0, c) + F(1, r) * F(1, c) + F(2, r) * F(2, c);
  return C;
}

// J^(-2/3)
inline Pack isochoric_factor(Pack J) { return fast_exp((-2.0 / 3.0) * fast_log(J)); }

// U(J) = K/4 (J^2 - 1 - 2 ln J) (Simo, Taylor 1982): grows without bound for J -> 0 and J -> infinity. J U'(J).
inline Pack volumetric_energy(double K, Pack J) { return 0.25 * K * (J * J - 1.0 - 2.0 * fast_log(J)); }
inline Pack volumetric_kirchhoff(double K, Pack J) { return 0.5 * K * (J * J - 1.0); }
inline Pack pressure_of_split_law(double K, Pack J) { return -0.5 * K * (J - 1.0 / J); }

}  // namespace shoal::solid
