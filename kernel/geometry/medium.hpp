// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What relaxing particles feel beyond the surface of their shape: a uniform medium, so that kernel sums go on
// there as integrals. It works for any shape, corners included, where mirror images would need planes.
#pragma once

#include <vector>

#include "relax.hpp"

namespace shoal::kernel {

/// Sampling points and the volume of each.
struct Medium {
  std::vector<Point> places;
  std::vector<double> volumes;

  /// Puts fixed particles in the place of the medium, which is taken out within half the diagonal of a
  /// lattice cell.
  void give_way(const std::vector<Point>& fixed, const RelaxParameters& parameters);
};

/// Samples the medium outside the shape on a grid of half the spacing, as far as `reach` from the surface.
/// Cells that the surface cuts weigh by the share of them outside, taking the surface as flat. `inside` are
/// the extents of the particles; along periodic axes the grid fills the period and knows no outside.
[[nodiscard]] Medium sample_medium_outside(const RelaxParameters& parameters, const Box& inside,
                                           double reach);

}  // namespace shoal::kernel
