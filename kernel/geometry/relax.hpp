// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Disordered but uniform starting positions. Particles that start on a lattice leave it violently once they
// are sheared (the lattice stretches without a change of density, then collapses), so flows without walls to
// disturb them start from here: each particle is displaced at random, then shifted down the gradient of the
// concentration
//     dr_i = -0.5 h^2 sum_j V grad W(r_ij)        (Lind, Xu, Stansby, Rogers 2012), at most 0.1 dx a sweep,
// until sum_j V W(r_ij) is nearly one everywhere. Outside a shape the sum goes on as an integral over a
// uniform medium, so that particles settle at the distance from the surface that they have from one another.
#pragma once

#include <cstdint>
#include <vector>

#include "cell_grid.hpp"
#include "shape.hpp"

namespace shoal::kernel {

struct RelaxParameters {
  int dimension = 3;
  double spacing = 0.0;
  /// Axes along which particles leave through one face and enter through the other.
  PeriodicBox domain{};
  /// What keeps the particles together where the domain is not periodic. Faces that coincide with periodic
  /// ones do not count. May be null only where every axis is periodic.
  ShapePtr shape;
  /// Particles that stay where they are, those of a wall say, one lattice volume each. Where they stand they
  /// take the place of the uniform medium outside the shape.
  std::vector<Point> fixed;
  double displacement = 0.2;  ///< largest random displacement along each axis, in spacings
  std::uint64_t seed = 1;
  int sweeps = 20;          ///< at most
  double tolerance = 2e-3;  ///< stop when no particle moves further in a sweep, in spacings
  double smoothing = 1.3;   ///< smoothing length in spacings; Wendland C2, cut off at twice that
};

/// How far sum_j V W(r_ij), with what is outside the shape, is from one. A lattice is not at zero: its kernel
/// sum has an error of its own, 1 % at 1.3 spacings, the same for each particle. What disorder adds is the
/// spread.
struct Uniformity {
  double rms = 0.0;
  double largest = 0.0;
  double mean = 0.0;          ///< of the signed error
  double spread = 0.0;        ///< rms about the mean
  double closest_pair = 0.0;  ///< in spacings; infinite where no two particles are within reach
};

struct RelaxReport {
  int sweeps = 0;
  bool converged = false;     ///< stopped by the tolerance
  double largest_move = 0.0;  ///< of the last sweep, in spacings
  Uniformity displaced;       ///< after the random displacement, before the first sweep
  Uniformity relaxed;
};

/// Displaces and relaxes the points in place; their order stays. The displacement of a point depends on the
/// seed and its index alone, and all sums are serial in a fixed order, so the result is the same in every
/// run.
///
/// How many sweeps: the spread of the kernel sum, and the closest pair in spacings, in a periodic box after a
/// displacement of 0.2 (test "relaxation: quality by sweeps" prints it):
///     sweeps            0      2      5     10     20     40    160
///     2D, 50 x 50  6.0e-2 9.5e-3 4.6e-3 2.9e-3 2.0e-3 1.6e-3 2.5e-3     closest 0.61 at 0, 0.94 at 20
///     3D, 16^3     4.9e-2 6.5e-3 3.4e-3 2.3e-3 1.7e-3 1.6e-3            closest 0.61 at 0, 0.82 at 20
/// Ten sweeps are good, twenty (the default) are nearly all there is to gain. Later the particles leave the
/// square lattice that they still resemble for denser packings, and moves no longer decrease: more sweeps
/// only cost. Near a flat surface of a shape the sum is off by up to 4 % even for a lattice, since the medium
/// outside is uniform and the particles are not (8 % measured in the tips of a polygon); beside the wall's
/// own particles (`fixed`) it is not.
///
/// Cost on one core: 1.3 us per particle and sweep in 2D, 5 to 7 us in 3D; some 200 bytes per particle in 3D.
///
/// Throws std::invalid_argument where a periodic axis is shorter than two cut-offs, points lie outside the
/// domain or shape, or an axis has neither a period nor a shape.
RelaxReport relax(std::vector<Point>& points, const RelaxParameters& parameters);

/// The quality of any distribution, measured as relax() does.
[[nodiscard]] Uniformity measure_uniformity(const std::vector<Point>& points,
                                            const RelaxParameters& parameters);

}  // namespace shoal::kernel
