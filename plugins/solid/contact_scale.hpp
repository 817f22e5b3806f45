// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What contact sums give where two bodies on lattices, dx_a and dx_b apart inside, lie flat on each other: their
// outermost particles are then (dx_a + dx_b) / 2 apart, since each particle stands for the volume around it.
//   colour     phi = sum_j V_j W of a half-space at a distance: what a particle sees when it just touches
//   stiffness  the pressure over (overlap / dx) of the force of contact.hpp with K = 1 Pa
// Sums are averaged over positions along the surface, of which they hardly depend: half a percent for h = 1.3 dx.
#pragma once

#include <algorithm>
#include <cmath>

#include "shoal/operator.hpp"

namespace shoal::solid {

struct ContactScale {
  double colour_a = 0, colour_b = 0;  // of a particle of a and of b
  double stiffness = 0;               // 1
};

namespace contact_sums {

// Sums f(r) over the lattice points of a plane at distance z, averaged over 4 (16) positions above a cell.
template <class Function>
double over_plane(int dimensions, double dx, double cutoff, double z, Function&& f) {
  if (z >= cutoff) return 0.0;
  const int n = static_cast<int>(cutoff / dx) + 2, depth = dimensions == 3 ? n : 0;
  const int phases = dimensions == 3 ? 4 : 1;
  double sum = 0.0;
  for (int p = 0; p < 4; ++p)
    for (int q = 0; q < phases; ++q)
      for (int a = -n; a <= n; ++a)
        for (int b = -depth; b <= depth; ++b) {
          const double x = (a + 0.25 * p) * dx, y = dimensions == 3 ? (b + 0.25 * q) * dx : 0.0;
          sum += f(std::sqrt(x * x + y * y + z * z));
        }
  return sum / (4 * phases);
}

template <class Kernel>
double colour(const Kernel& kernel, int dimensions, double dx, double distance) {
  double sum = 0.0;
  for (double z = distance; z < kernel.cutoff(); z += dx)
    sum += over_plane(dimensions, dx, kernel.cutoff(), z, [&](double r) { return kernel.w(r); });
  return sum * std::pow(dx, dimensions);
}

// Pressure over K when the bodies overlap by `overlap`.
template <class Kernel>
double pressure(const Kernel& kernel, int dimensions, double dx_a, double dx_b, double overlap,
                const ContactScale& scale) {
  const double gap = 0.5 * (dx_a + dx_b) - overlap, volume_b = std::pow(dx_b, dimensions);
  double sum = 0.0;
  for (double a = 0.0; a < kernel.cutoff(); a += dx_a)
    for (double b = 0.0; a + b + gap < kernel.cutoff(); b += dx_b) {
      const double z = gap + a + b;
      const double seen_a = std::max(0.0, colour(kernel, dimensions, dx_b, gap + a) - scale.colour_a);
      const double seen_b = std::max(0.0, colour(kernel, dimensions, dx_a, gap + b) - scale.colour_b);
      sum -=
          dx_a * volume_b * (seen_a + seen_b) *
          over_plane(dimensions, dx_b, kernel.cutoff(), z, [&](double r) { return kernel.dw_over_r(r) * z; });
    }
  return sum;
}

}  // namespace contact_sums

inline ContactScale contact_scale(int dimensions, const Target& target, double dx_a, double dx_b) {
  const auto sums = [&](const auto& kernel) {
    ContactScale scale;
    scale.colour_a = contact_sums::colour(kernel, dimensions, dx_b, 0.5 * (dx_a + dx_b));
    scale.colour_b = contact_sums::colour(kernel, dimensions, dx_a, 0.5 * (dx_a + dx_b));
    constexpr double overlap = 0.1;  // of the smaller spacing; the force is linear there to a few percent
    const double dx = std::min(dx_a, dx_b);
    scale.stiffness = contact_sums::pressure(kernel, dimensions, dx_a, dx_b, overlap * dx, scale) / overlap;
    return scale;
  };
  return dimensions == 2 ? with_kernel<2>(target.smoothing_kernel, target.smoothing_length, sums)
                         : with_kernel<3>(target.smoothing_kernel, target.smoothing_length, sums);
}

}  // namespace shoal::solid
