// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The largest magnitude of an eigenvalue of a discrete operator, by power iteration.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "stencil.hpp"

namespace shoal::diffusion {

// In 1/s. Neighbours in images and other bodies are taken to be at zero: the eigenvectors that matter alternate from
// particle to particle and do not care. From 24 iterations it comes out a few per cent low at most. Serial, and costs as
// much as 24 evaluations of the rate; it is done once for bodies at rest.
template <class Op>
double spectral_radius(const Op& op, const Stencil& stencil, bool with_more = false) {
  const std::size_t n = op.n_particles();
  if (n == 0) return 0.0;
  std::vector<double> c(n), next(n), diagonal(n);
  std::uint64_t random = 0x9e3779b97f4a7c15u;
  const auto weight = [&](std::size_t k, std::uint64_t entry) {
    return stencil.weights[k][entry] + (with_more ? stencil.more[k][entry] : 0.0);
  };
  for (double& value : c) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    value = static_cast<double>(random >> 11) / 9007199254740992.0 - 0.5;
  }
  for (std::size_t k = 0; k < op.n_relations(); ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::uint32_t m = 0; m < op.neighbours(k).counts[i]; ++m)
        diagonal[i] += weight(k, op.neighbours(k).offsets[i] + m);
  for (const auto& chunk : stencil.surface)
    for (const SurfaceWeight& w : chunk) diagonal[w.i] += w.per_value + (with_more ? w.more_per_value : 0.0);

  double radius = 0;
  const shoal_neighbours& list = op.neighbours(0);
  for (int iteration = 0; iteration < 24; ++iteration) {
    double before = 0, after = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = -diagonal[i] * c[i];
      for (std::uint64_t entry = list.offsets[i]; entry < list.offsets[i] + list.counts[i]; ++entry)
        if (list.indices[entry] < n) sum += weight(0, entry) * c[list.indices[entry]];
      next[i] = sum;
      before += c[i] * c[i];
      after += sum * sum;
    }
    if (!(before > 0.0) || !(after > 0.0)) break;
    radius = std::sqrt(after / before);
    const double scale = 1.0 / std::sqrt(after);
    for (std::size_t i = 0; i < n; ++i) c[i] = scale * next[i];
  }
  return radius;
}

}  // namespace shoal::diffusion
