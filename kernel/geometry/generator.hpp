// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fills a shape with particles on a lattice.
#pragma once

#include <cstdint>
#include <vector>

#include "shape.hpp"

namespace shoal::kernel {

enum class Lattice {
  cubic,      ///< centres at origin + (k + 1/2) spacing along each axis
  hexagonal,  ///< 2D: rows offset by half a distance; 3D: hexagonal close packing. Same volume per particle
              ///< as cubic
};

struct LatticeOptions {
  Point origin{};  ///< a corner of a lattice cell; align it with the faces that the particles should fit
  Lattice kind = Lattice::cubic;
  std::uint64_t limit =
      50'000'000;  ///< most particles that are given; more is refused before memory is taken
};

/// Volume (area in 2D) that one particle stands for: spacing^dimension, on each lattice.
[[nodiscard]] double lattice_volume(double spacing, int dimension);

/// Number of particles that fill_lattice() will find, from a coarse integral of the volume: within 1 %, for
/// shells down to a hundredth of the size. Takes no memory, and 0.1 s in 3D (0.01 s in 2D) whatever the
/// spacing. Throws std::invalid_argument where the shape is unbounded.
[[nodiscard]] double estimate_count(const Shape& shape, double spacing, int dimension);

/// Lattice points that the shape holds, ordered by z, then y, then x. Points within 1e-6 spacing of a surface
/// count as on it (see Shape::contains), so rounding neither loses nor doubles a row: a box whose sides are n
/// spacings gives n rows wherever its origin lies. Whole runs inside or outside are strode over by the signed
/// distance; the cost is that of the points found plus a few distances for each row. Throws
/// std::invalid_argument where the shape is unbounded, or has no meaning in this dimension, or the spacing is
/// not positive; std::length_error, with the numbers, where there would be more particles than the limit.
[[nodiscard]] std::vector<Point> fill_lattice(const Shape& shape, double spacing, int dimension,
                                              const LatticeOptions& options = {});

}  // namespace shoal::kernel
