// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the total Lagrangian scheme keeps of the reference configuration: for each pair (i, j) of neighbours the
// weight G_ij of the gradient and the weight psi_ij of the hourglass residual,
//   grad f_i = sum_j (f_j - f_i) G_ij,      residual_i = -sum_j (f_j - f_i) psi_ij.
//
// Around i a field is taken as f_j - f_i = c . p_ij with the monomials p_ij = (X, Y, X^2, X Y, Y^2) of
// (X_j - X_i) / h, and c minimises sum_j w_ij (f_j - f_i - c . p_ij)^2, w_ij = V_j W_ij. With the moments
// M = sum_j w p p^T, m = sum_j w p, s = sum_j w:
//   G_ij   = w_ij / h (rows of the gradient of M^-1) p_ij,
//   psi_ij = v_ij (1 - p_ij . M_v^-1 m_v) / s_v,      v_ij = V_j (1 - r^2 / (2 h)^2) or V_j,
// M_v, m_v, s_v being the moments with v in place of w.
// The residual is what of f the same fit with a free value at i does not explain, so it vanishes for quadratic
// fields (bending is not stiffened) and not for modes that alternate from particle to particle, which no gradient
// sees. It is scaled so that its gain on f_i stays below one where neighbours are on one side only. It needs weights v
// that fall off slowly: a quadratic passes through any three layers, and w leaves little more than three (of two spacings
// it is half a per cent of that of one), so that with it the residual of what alternates from layer to layer was 0.03 of
// its amplitude in 3D, against 0.45 where it alternates along all axes; with v they are 0.22 and 0.22 (in 2D 0.44, 0.48).
// Behind the outermost layer v is V_j within 2.1 spacings and zero beyond: that sees as much (0.20 and 0.22; in 2D 0.44,
// 0.44) of 32 neighbours as the other of 56 (12 of 20 in 2D), so that the control costs less. Surfaces have few neighbours: with
// the near ones alone a column of four particles across lost its turns at half the default strength.
//
// eps (M_XX + M_YY) is added to the diagonal of the quadratic terms: linear fields stay exact, and the weights of
// disordered particles at surfaces lose their peaks, which would cost time step. At corners, where a body has no
// stress to speak of, the quadratic fit has its largest weights, and those few particles would set the step of all: eps
// is a hundred times as large there, and the largest frequency of a lattice in 2D falls from 2.37 to 1.87 c / dx (c the speed of longitudinal
// waves), in 3D from 2.52 to 2.16. Where neighbours are too few for the
// quadratic fit, and if `quadratic` is off, G is that of Bonet and Lok (1999), exact for linear fields:
//   G_ij = V_j B_i grad W_ij,   B_i = (sum_j V_j (X_j - X_i) (x) grad W_ij)^-1.
//
// Both weights of both directions are kept with the differences of numbers j - i, as a stencil (stencils.hpp). Particles
// of a lattice share stencils: weights that differ by rounding are made the same, so that a body of any size needs a few
// hundred of them. Disordered ones need 16 (D + 1) + 4 bytes a pair.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "held_surface.hpp"
#include "pressure_grid.hpp"
#include "shoal/abi.h"
#include "stencils.hpp"

namespace shoal::solid {

// Numbers aligned as SIMD loads like them, zero at first, with a few more behind the last.
class AlignedNumbers {
 public:
  void assign(std::size_t n);
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return n_; }

 private:
  struct Delete {
    void operator()(double* p) const { ::operator delete[](p, std::align_val_t(64)); }
  };
  std::unique_ptr<double[], Delete> data_;
  std::size_t n_ = 0;
};

struct ReferenceSettings {
  bool quadratic = true;
  double smoothing_length = 0;  // m, of the Wendland C2 weight
  double spacing = 0;           // m
  double eps = 0.01;
  bool consistent = true;  // forces of a uniform stress vanish inside (force_consistency.hpp)
};

// Arrays of a body's particles in the reference configuration.
struct ReferenceGeometry {
  const double *position, *volume;
  const double *normal, *distance;  // of the body's surface: outward, negative inside
  const HeldSurface* held = nullptr;
};

// What making forces consistent came to (force_consistency.hpp).
struct ForceConsistency {
  double before = 0, after = 0;  // root mean square of the constrained part of r, times the spacing
  int iterations = 0;
};

// Isotropic constants for the estimate of the largest frequency.
struct Stiffness {
  double lambda = 0, mu = 0;  // Pa
  double hourglass = 0;       // Pa, modulus of the hourglass control
  double density = 0;         // kg/m3
  // Where pressure is taken on a grid: of the modulus lambda, `bulk` acts on the volume ratios of its nodes.
  const PressureGrid* grid = nullptr;
  double bulk = 0;  // Pa
};

// What `linear_force` computes on the way.
struct LinearSpace {
  AlignedNumbers stress, held;
  std::vector<double> trace, nodes;
};

// Row i of a neighbour list.
struct Row {
  const std::uint32_t* j;
  std::uint32_t n;
};
inline Row row_of(const shoal_neighbours& list, std::uint64_t i) {
  return {list.indices + list.offsets[i], list.counts[i]};
}

class ReferenceRows;

class ReferenceWeights {
 public:
  bool built() const { return n_ > 0; }
  // Throws CaseError if the list holds images (of periodic or mirror faces).
  void build(int dimensions, const ReferenceSettings& settings, const shoal_neighbours& list,
             const ReferenceGeometry& geometry);

  Stencil stencil(std::uint64_t i) const { return stencil_of(run_of(i)->pattern); }
  // F (row by row) and the residual times `stiffness` of particles begin ... end - 1 at positions x.
  template <int D, bool Hourglass = true>
  void deform(std::uint64_t begin, std::uint64_t end, const double* x, double stiffness, double* F,
              double* q) const {
    const StencilArrays all = arrays();
    sweep(
        begin, end,
        [&](const Stencil& stencil, std::uint64_t i) {
          deformations<D, Hourglass>(stencil, x, stiffness, i, F, q);
        },
        [&](const Loners& loners) { deformations<D, Hourglass>(all, loners, x, stiffness, F, q); });
  }
  // Their force per volume, N/m3, times `factor`.
  template <int D, bool Hourglass>
  void force(std::uint64_t begin, std::uint64_t end, const double* P, const double* q, double factor,
             double* out) const {
    const StencilArrays all = arrays();
    sweep(
        begin, end,
        [&](const Stencil& stencil, std::uint64_t i) { forces<D, Hourglass>(stencil, P, q, factor, i, out); },
        [&](const Loners& loners) { forces<D, Hourglass>(all, loners, P, q, factor, out); });
  }
  // Adds what shifting held particles to the surface changes (held_surface.hpp), behind `deform`.
  template <int D, bool Hourglass>
  void correct(std::uint64_t begin, std::uint64_t end, double stiffness, double* F, double* q) const {
    const auto by_particle = [](const Correction& a, std::uint64_t i) { return a.i < i; };
    for (auto at = std::lower_bound(corrections_.begin(), corrections_.end(), begin, by_particle);
         at != corrections_.end() && at->i < end; ++at) {
      for (std::uint64_t k = 0; k < D * D; ++k) F[at->i * D * D + k] += at->F[k];
      for (std::uint64_t k = 0; Hourglass && k < D; ++k) q[at->i * D + k] += stiffness * at->residual[k];
    }
  }
  std::size_t n_patterns() const { return patterns_.size(); }

  // Largest angular frequency (rad/s) of the undeformed discrete body, by Lanczos iteration; half a per cent or so from
  // below.
  double largest_frequency(const Stiffness& stiffness, const double* volume) const;
  // Force per volume (N/m3) of small displacements u (m) of the undeformed body.
  void linear_force(const Stiffness& stiffness, const double* u, double* out, LinearSpace& space) const;
  // Displacements without any symmetry, to begin an iteration with.
  void random_start(AlignedNumbers& u) const;
  // sum_j (G_ij - V_j / V_i G_ji) of particle i, 1/m: the force of a uniform stress, zero for no force.
  void residual(std::uint64_t i, double* out) const;
  std::uint64_t bytes() const;
  const ForceConsistency& consistency() const { return consistency_; }

 private:
  struct Run {
    std::uint32_t begin, pattern;  // ends where the next begins
  };
  struct Correction {
    std::uint64_t i;
    double F[9], residual[3];
  };
  struct Pattern {
    std::uint32_t n, controlled;
    std::uint64_t first;  // pair
  };
  const Run* run_of(std::uint64_t i) const {
    return std::upper_bound(runs_.data(), runs_.data() + runs_.size(), i,
                            [](std::uint64_t k, const Run& run) { return k < run.begin; }) -
           1;
  }
  Stencil stencil_of(std::uint32_t pattern) const {
    const Pattern& known = patterns_[pattern];
    return {known.n,
            known.controlled,
            pattern,
            known.first,
            offsets_.data() + known.first,
            forward_.data() + known.first * stride_,
            backward_.data() + known.first * stride_,
            sums_.data() + pattern * stride_};
  }
  StencilArrays arrays() const {
    return {offsets_.data(), forward_.data(), backward_.data(), sums_.data(),
            static_cast<std::uint32_t>(offsets_.size())};
  }
  // Particles begin ... end - 1: many(stencil, i) for particles i ... i + group - 1 with the same stencil, others(loners)
  // for those in shorter runs. The last group of a run overlaps the one before where they do not come out even, which
  // computes the same numbers twice.
  template <class Many, class Others>
  void sweep(std::uint64_t begin, std::uint64_t end, const Many& many, const Others& others) const {
    if (begin >= end) return;
    Loners loners;
    const auto treat = [&] {
      loners.close();
      others(loners);
    };
    for (const Run* run = run_of(begin); begin < end; ++run) {
      const std::uint64_t stop = std::min<std::uint64_t>(end, run[1].begin);
      const Stencil stencil = stencil_of(run->pattern);
      if (stop - begin < group) {
        for (; begin < stop; ++begin) {
          loners.add(begin, stencil);
          if (loners.full()) treat();
        }
        continue;
      }
      for (; begin + group <= stop; begin += group) many(stencil, begin);
      if (begin < stop) many(stencil, stop - group);
      begin = stop;
    }
    if (!loners.empty()) treat();
  }
  template <int D>
  void linear_force(const Stiffness& stiffness, const double* u, double* out, LinearSpace& space) const;
  class SortedRow;
  void keep(const ReferenceRows& rows, const double* volume);
  void look_at_held(const HeldSurface& held);

  std::uint64_t n_ = 0;
  int dimensions_ = 0;
  std::size_t stride_ = 0;
  double spacing_ = 0;
  ForceConsistency consistency_;
  std::vector<Correction> corrections_;  // by particle
  std::vector<Run> runs_;                // and one behind the last particle
  std::vector<Pattern> patterns_;
  std::vector<std::int32_t> offsets_;
  std::vector<double> forward_, backward_, sums_;  // and a few behind the last: loads of four begin there too
};

}  // namespace shoal::solid
