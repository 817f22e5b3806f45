// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Plane waves of the ventricular cell at an angle to the axes of a lattice, with the coefficients that wave_speed_of
// makes right along the axes (conservative scheme, 3D, fibres along x as in the slab of Niederer et al. 2011). Planes
// normal to whole numbers n of spacings are dx / |n| apart: again a wave on a line. Prints speed / exact speed:
//     test_wave_directions 0.2 1.3      (spacing in mm, smoothing ratio)
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "cells.hpp"
#include "line_weights.hpp"
#include "ten_tusscher_panfilov.hpp"
#include "wave_speed.hpp"

using namespace shoal;
using namespace shoal::diffusion;

namespace {

// m2/s
constexpr double along = 0.17 * 0.62 / 0.79 / 1.4e3, across = 0.019 * 0.24 / 0.259 / 1.4e3;
using Normal = std::array<int, 3>;

double length(const Normal& n) { return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]); }

// Weights of the planes normal to n, gathered over the neighbours of a particle.
std::vector<double> plane_weights(double dx, double ratio, const AxisValues& d, const Normal& n) {
  std::vector<double> weights;
  with_kernel<3>(SmoothingKernel::wendland_c2, ratio * dx, [&](const auto& kernel) {
    const Mat<3> b = LatticeMoments<3>(kernel, dx).b_of(diagonal<3>(d));
    const int reach = static_cast<int>(kernel.cutoff() / dx) + 1;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z) {
          const int plane = x * n[0] + y * n[1] + z * n[2];
          const Vec<3> r{x * dx, y * dx, z * dx};
          const double far = norm(r);
          if (plane <= 0 || far >= kernel.cutoff()) continue;
          if (weights.size() < static_cast<std::size_t>(plane))
            weights.resize(static_cast<std::size_t>(plane));
          weights[static_cast<std::size_t>(plane) - 1] -=
              2.0 * dx * dx * dx * kernel.dw_over_r(far) * dot(r, b * r) / (far * far);
        }
  });
  return weights;
}

}  // namespace

int main(int argc, char** argv) {
  const double dx = 1e-3 * (argc > 1 ? std::atof(argv[1]) : 0.2), ratio = argc > 2 ? std::atof(argv[2]) : 1.0;
  const test::DefaultObject<TenTusscherPanfilov> object("test.model");
  const TenTusscherPanfilov model;
  const ReactionIntegrator reaction(test::interface_of(model));
  const WaveSpeedCorrection correction(object.object(), 3, dx, [&](const AxisValues& d, std::size_t axis) {
    Normal n{};
    n[axis] = 1;
    return plane_weights(dx, ratio, d, n);
  });
  const AxisValues raised = correction(AxisValues{along, across, across});
  const auto speed = [&](const Normal& n) {
    const double spacing = dx / length(n);
    const auto nodes = static_cast<std::size_t>(std::max(48.0, std::min(400.0, 12e-3 / spacing)));
    return wave_speed(reaction, {plane_weights(dx, ratio, raised, n), spacing, 5e-5, nodes, 1.0});
  };
  const double per_root = speed({1, 0, 0}) / std::sqrt(along);
  std::printf("%g mm, ratio %g: coefficients raised to %.3f along and %.3f across the fibres\n", 1e3 * dx,
              ratio, raised[0] / along, raised[1] / across);
  for (const Normal& n :
       {Normal{1, 1, 0}, Normal{1, 2, 0}, Normal{1, 3, 0}, Normal{1, 5, 0}, Normal{1, 3, 1}, Normal{1, 2, 2},
        Normal{1, 3, 3}, Normal{0, 1, 0}, Normal{0, 1, 2}, Normal{0, 1, 1}}) {
    const double k = (n[0] * n[0] * along + (n[1] * n[1] + n[2] * n[2]) * across) / (length(n) * length(n));
    std::printf("  normal to (%d, %d, %d): %.3f\n", n[0], n[1], n[2], speed(n) / (per_root * std::sqrt(k)));
  }
}
