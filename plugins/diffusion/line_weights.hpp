// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The schemes on a plane wave that runs along an axis of the lattice: weights of the planes n spacings apart.
#pragma once

#include <cstddef>
#include <vector>

#include "fit.hpp"
#include "pairwise.hpp"
#include "reaction/wave_speed.hpp"

namespace shoal::diffusion {

// Calls visit(r, plane) for the neighbours r of a particle of the lattice in the planes in front of it.
template <int D, class Kernel, class Visit>
void for_planes_in_front(const Kernel& kernel, double dx, std::size_t axis, Visit&& visit) {
  const int n = static_cast<int>(kernel.cutoff() / dx) + 1;
  for (int plane = 1; plane <= n; ++plane)
    for (int u = -n; u <= n; ++u)
      for (int v = D == 3 ? -n : 0; v <= (D == 3 ? n : 0); ++v) {
        Vec<D> r{};
        r[static_cast<int>(axis)] = plane * dx;
        r[static_cast<int>((axis + 1) % D)] = u * dx;
        if constexpr (D == 3) r[static_cast<int>((axis + 2) % D)] = v * dx;
        if (norm(r) < kernel.cutoff()) visit(r, static_cast<std::size_t>(plane - 1));
      }
}

template <int D>
Mat<D> diagonal(const AxisValues& d) {
  Mat<D> k{};
  for (int a = 0; a < D; ++a) k(a, a) = d[static_cast<std::size_t>(a)];
  return k;
}

// l_1, l_2, ... in 1/s of the tensor (or isotropic coefficient) with values `d` on the axes: conservative scheme.
template <int D, class Kernel>
std::vector<double> pairwise_line_weights(const Kernel& kernel, double dx, bool isotropic,
                                          const AxisValues& d, std::size_t axis) {
  const LatticeMoments<D> lattice(kernel, dx);
  const Mat<D> b =
      isotropic ? Mat<D>((1.0 / lattice.slope()) * diagonal<D>(d)) : lattice.b_of(diagonal<D>(d));
  const double volume = D == 2 ? dx * dx : dx * dx * dx;
  std::vector<double> weights(static_cast<std::size_t>(kernel.cutoff() / dx) + 1, 0.0);
  for_planes_in_front<D>(kernel, dx, axis, [&](const Vec<D>& r, std::size_t plane) {
    const double length = norm(r);
    weights[plane] -= 2.0 * volume * kernel.dw_over_r(length) * dot(r, b * r) / (length * length);
  });
  return weights;
}

// The same of the accurate scheme. Empty if the neighbours of the lattice do not determine the fit.
template <int D, class Kernel>
std::vector<double> fit_line_weights(const Kernel& kernel, double dx, const AxisValues& d, std::size_t axis) {
  constexpr int terms = Quadratic<D>::terms;
  const double per_h = 1.0 / kernel.h();
  SmallMatrix<terms> moments;
  const auto add = [&](const Vec<D>& r) {
    const auto p = Quadratic<D>::monomials(per_h * r);
    const double w = kernel.w(norm(r));
    for (std::size_t a = 0; a < p.size(); ++a)
      for (std::size_t b = 0; b < p.size(); ++b)
        moments(static_cast<int>(a), static_cast<int>(b)) += w * p[a] * p[b];
  };
  const int n = static_cast<int>(kernel.cutoff() / dx) + 1;
  for (int x = -n; x <= n; ++x)
    for (int y = -n; y <= n; ++y)
      for (int z = D == 3 ? -n : 0; z <= (D == 3 ? n : 0); ++z) {
        Vec<D> r{};
        r[0] = x * dx;
        r[1] = y * dx;
        if constexpr (D == 3) r[2] = z * dx;
        if (norm(r) > 0.0 && norm(r) < kernel.cutoff()) add(r);
      }
  if (invert(moments) < 1e-8) return {};
  const auto g = Quadratic<D>::contraction(moments, diagonal<D>(d), kernel.h());
  std::vector<double> weights(static_cast<std::size_t>(n), 0.0);
  for_planes_in_front<D>(kernel, dx, axis, [&](const Vec<D>& r, std::size_t plane) {
    weights[plane] += kernel.w(norm(r)) * Quadratic<D>::dot(g, Quadratic<D>::monomials(per_h * r));
  });
  return weights;
}

}  // namespace shoal::diffusion
