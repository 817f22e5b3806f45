// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What SPH sums give on the lattice of the initial spacing, to normalise them:
//   sigma0 = sum_j W_ij, itself included                 density summation measures against it
//   slope  = -sum_j V_j W' x_ij^2 / r_ij                 the gradient of the linear field x, 1 in the limit
// With few neighbours the slope is wrong by some percent (Wendland C2, h = 1.3 dx: 0.974 in 2D, 0.979 in 3D), and on
// disordered particles it is wrong by the same amount on average (0.976 in 2D). A constant factor 1/slope on every
// gradient removes that error and, unlike a correction matrix for each particle, keeps sums antisymmetric: momentum
// and angular momentum are conserved to rounding. The Laplacian of viscosity has the same sum in it.
#pragma once

#include <cmath>

#include "shoal/operator.hpp"

namespace shoal::fluid {

struct LatticeSums {
  double w = 0;      // 1/m^D
  double slope = 0;  // 1
};

inline LatticeSums lattice_sums(int dimensions, const Target& target) {
  const double dx = target.spacing;
  const auto sum = [&](const auto& kernel) {
    const int n = static_cast<int>(kernel.cutoff() / dx) + 1;
    const int depth = dimensions == 3 ? n : 0;
    const double volume = std::pow(dx, dimensions);
    LatticeSums total;
    for (int a = -n; a <= n; ++a)
      for (int b = -n; b <= n; ++b)
        for (int c = -depth; c <= depth; ++c) {
          const double r = dx * std::sqrt(static_cast<double>(a * a + b * b + c * c)), x = a * dx;
          total.w += kernel.w(r);
          total.slope -= volume * kernel.dw_over_r(r) * x * x;
        }
    return total;
  };
  return dimensions == 2 ? with_kernel<2>(target.smoothing_kernel, target.smoothing_length, sum)
                         : with_kernel<3>(target.smoothing_kernel, target.smoothing_length, sum);
}

}  // namespace shoal::fluid
