// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a body is built into something rigid: the displacement vanishes at the surface of a shape (solid.clamp with
// `built_into`), wherever the particles happen to lie.
//
// Particles inside the shape are held. To hold them alone does not say where the body ends: a fit around a free particle
// sees a field with a kink somewhere between the last held particle and the first free one, and the length of the body is
// known to a spacing at best. So held particles take no part but in the fits around free ones, where those no deeper
// than a spacing stand for the points of the surface that are nearest to them, X_j - d_j n_j (d the signed distance,
// n its gradient): the displacement there is known, and it is zero. The fits are then those of a body with a surface whose
// displacement is given, of the order that they have elsewhere. The energy is that of the free particles, whose volumes
// are what of their cells is in front of the surface, and what of the cells of held ones is, given to the nearest free
// particle; so forces are its gradient as ever. Sums over neighbours run over positions, not displacements, so the
// difference that the shift to the surface makes is added to F and to the hourglass residual,
//   F_i += -sum_j d_j n_j (x) G_ij   (j held),   r_i += sum_j d_j n_j psi_ij,   F_i = 1 for held particles.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "region.hpp"
#include "shoal/interfaces/stress_law.h"
#include "shoal/physics.hpp"

namespace shoal::solid {

using HeldRegions = std::shared_ptr<std::vector<Region>>;

// Of a body; the physics of clamps and of motion are built one after the other, whichever comes first.
HeldRegions held_regions(const Builder& b, BodyIndex body);

// The particles as the shapes see them; empty where there are none.
struct HeldSurface {
  std::vector<double> distance;  // m, to the surface of the nearest shape
  std::vector<double> shift;     // m, from the surface to the particle, D a particle

  double spacing = 0;  // m

  // A particle that stands nearly in the surface has no cell to speak of in front of it, and would set the step of all.
  static double margin(double spacing) { return 0.1 * spacing; }

  bool empty() const { return distance.empty(); }
  bool holds(std::uint64_t i) const { return !empty() && distance[i] <= margin(spacing); }
  // Held, and one that stands for a point of the surface.
  bool shows(std::uint64_t i) const { return holds(i) && distance[i] > margin(spacing) - 0.999 * spacing; }
  void look(const std::vector<Region>& regions, int dimensions, std::uint64_t n, const double* position,
            double dx);
};

// Moves what of the cells of particles lies across the surface: changes the volumes of free ones.
void cut_volumes(const HeldSurface& surface, int dimensions, const double* position, double* volume);

// The sum over particles is the midpoint rule, whose error, h^2/24 times the difference of slopes between the ends (0.7 % of
// the bending stiffness with 12 particles across), the slope between the two outermost layers takes away: they weigh
// 25/24 and 23/24. `distance` is that of the body's surface, negative inside.
void correct_ends(std::uint64_t n, const double* distance, double spacing, double* volume);

}  // namespace shoal::solid
