// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The two sums over neighbours of the total Lagrangian scheme, with stored weights,
//   F_i = sum_j (x_j - x_i) (x) G_ij,   r_i = -sum_j (x_j - x_i) psi_ij,
//   f_i = sum_j [P_i G_ij - V_j / V_i P_j G_ji] - sum_j [q_i psi_ij - V_j / V_i q_j psi_ji].
//
// The neighbours of a particle and their weights are a stencil: differences of numbers j - i, and the weights. On a
// lattice, particles that stand next to each other in the body's order have the same one, so SIMD runs over a group of
// such particles, whose neighbours stand next to each other too: loads without gathering, weights from cache, no sum across
// lanes before the end. Elsewhere SIMD runs over the components of a neighbour's matrices: one load and D fused
// multiply-adds a pair for F and the hourglass residual together, D + 1 loads for the force. Loads of 4 numbers reach
// one or two beyond a vector or a weight; arrays are padded, and the lanes are not used.
//
// Which particles go together is fixed by the stencils and the kernel's chunks, and each lane does what it would do
// anywhere else in a group, so results do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <cstring>

#include "shoal/vec.hpp"

namespace shoal::solid {

// Particles that are looked at together: as many as a register holds numbers.
#ifdef __AVX512F__
inline constexpr int group = 8;
#else
inline constexpr int group = 4;
#endif
typedef double VG __attribute__((vector_size(8 * group)));
typedef double V4 __attribute__((vector_size(32)));
typedef double V2 __attribute__((vector_size(16)));

template <class V>
inline void load(V& v, const double* p) {
  std::memcpy(&v, p, sizeof v);
}

// D + 1 numbers a neighbour: G, then psi; of i, and of the neighbours towards i times V_j / V_i.
struct Stencil {
  std::uint32_t n;
  const std::int32_t* offset;  // j - i
  const double *forward, *backward;
  const double* sums;  // of `forward`
};

template <int D>
struct Deformation {
  Mat<D> gradient;
  Vec<D> residual;  // of the hourglass control
};

// -- one particle -------------------------------------------------------------------------------------------------

// Two accumulators each, to hide the latency of the sums.
template <int D>
Deformation<D> deformation(const Stencil& stencil, const double* x, std::uint64_t i) {
  constexpr std::ptrdiff_t S = D + 1;
  const double* own = x + i * D;
  const double* weights = stencil.forward;
  V4 sum[D] = {}, other[D] = {};
  std::uint32_t m = 0;
  for (; m + 2 <= stencil.n; m += 2, weights += 2 * S) {
    const double *a = own + std::ptrdiff_t{stencil.offset[m]} * D,
                 *b = own + std::ptrdiff_t{stencil.offset[m + 1]} * D;
    V4 wa, wb;
    load(wa, weights), load(wb, weights + S);
    for (int r = 0; r < D; ++r) {
      sum[r] += (a[r] - own[r]) * wa;
      other[r] += (b[r] - own[r]) * wb;
    }
  }
  if (m < stencil.n) {
    const double* a = own + std::ptrdiff_t{stencil.offset[m]} * D;
    V4 wa;
    load(wa, weights);
    for (int r = 0; r < D; ++r) sum[r] += (a[r] - own[r]) * wa;
  }
  Deformation<D> result;
  for (int r = 0; r < D; ++r) {
    sum[r] += other[r];
    for (int k = 0; k < D; ++k) result.gradient(r, k) = sum[r][k];
    result.residual[r] = -sum[r][D];
  }
  return result;
}

// sum_j [P_j G'_ji - q_j psi'_ji]; P and q of particle i itself.
template <bool Hourglass>
Vec<3> force_of_neighbours(const Stencil& stencil, const double* P, const double* q, Vec<3>) {
  V4 sum[3] = {}, held{}, w, value;
  const double* weights = stencil.backward;
  for (std::uint32_t m = 0; m < stencil.n; ++m, weights += 4) {
    const double* p = P + std::ptrdiff_t{stencil.offset[m]} * 9;
    load(w, weights);
    for (int r = 0; r < 3; ++r) load(value, p + 3 * r), sum[r] += value * w;
    if constexpr (Hourglass)
      load(value, q + std::ptrdiff_t{stencil.offset[m]} * 3), held += value * weights[3];
  }
  Vec<3> result;
  for (int r = 0; r < 3; ++r) result[r] = sum[r][0] + sum[r][1] + sum[r][2] - held[r];
  return result;
}
template <bool Hourglass>
Vec<2> force_of_neighbours(const Stencil& stencil, const double* P, const double* q, Vec<2>) {
  V4 sum{}, other{};
  V2 held{};
  const auto add = [&](std::uint32_t m, const double* w, V4& to) {
    V4 value;
    load(value, P + std::ptrdiff_t{stencil.offset[m]} * 4);
    to += value * V4{w[0], w[1], w[0], w[1]};
    if constexpr (Hourglass) {
      V2 own;
      load(own, q + std::ptrdiff_t{stencil.offset[m]} * 2);
      held += own * w[2];
    }
  };
  const double* weights = stencil.backward;
  std::uint32_t m = 0;
  for (; m + 2 <= stencil.n; m += 2, weights += 6) {
    add(m, weights, sum);
    add(m + 1, weights + 3, other);
  }
  if (m < stencil.n) add(m, weights, sum);
  sum += other;
  return {sum[0] + sum[1] - held[0], sum[2] + sum[3] - held[1]};
}

// Force per reference volume on particle i, N/m3: the exact transpose of `deformation`, so that momentum, angular
// momentum and energy are conserved; q is the derivative of the hourglass energy with respect to the residual.
template <int D, bool Hourglass>
Vec<D> force(const Stencil& stencil, const double* P, const double* q, std::uint64_t i) {
  const double *own = P + i * D * D, *own_q = q + i * D;
  Vec<D> f = -force_of_neighbours<Hourglass>(stencil, own, own_q, Vec<D>{});
  for (int r = 0; r < D; ++r) {
    for (int k = 0; k < D; ++k) f[r] += own[r * D + k] * stencil.sums[k];
    if constexpr (Hourglass) f[r] -= own_q[r] * stencil.sums[D];
  }
  return f;
}

// -- a group of particles, one after the other, with the same stencil ----------------------------------------------

// F (row by row) and residual times `stiffness` of particles i ... i + group - 1.
template <int D>
void deformations(const Stencil& stencil, const double* x, double stiffness, std::uint64_t i, double* F,
                  double* q) {
  VG own[D], sum[D + 1][D] = {};
  for (int v = 0; v < D; ++v) load(own[v], x + i * D + static_cast<std::uint64_t>(group * v));
  const double* w = stencil.forward;
  for (std::uint32_t m = 0; m < stencil.n; ++m, w += D + 1) {
    const double* theirs = x + (static_cast<std::ptrdiff_t>(i) + stencil.offset[m]) * D;
    for (int v = 0; v < D; ++v) {
      VG difference;
      load(difference, theirs + group * v);
      difference -= own[v];
      for (int c = 0; c <= D; ++c) sum[c][v] += difference * w[c];
    }
  }
  for (int c = 0; c < D; ++c) {
    double column[group * D];
    std::memcpy(column, sum[c], sizeof column);
    for (int k = 0; k < group * D; ++k) F[i * D * D + static_cast<std::size_t>(k * D + c)] = column[k];
  }
  for (int v = 0; v < D; ++v) {
    const VG held = -stiffness * sum[D][v];
    std::memcpy(q + i * D + static_cast<std::uint64_t>(group * v), &held, sizeof held);
  }
}

// What `force` gives, times `factor`, of particles i ... i + group - 1. Lanes hold the components of P one after the other, so
// weights repeat with period D.
template <int D, bool Hourglass>
void forces(const Stencil& stencil, const double* P, const double* q, double factor, std::uint64_t i,
            double* out) {
  VG sum[D * D], held[D];
  const auto spread = [](const double* w, VG* pattern) {
    V4 four;
    load(four, w);
#ifdef __AVX512F__
    if constexpr (D == 2) {
      pattern[0] = __builtin_shufflevector(four, four, 0, 1, 0, 1, 0, 1, 0, 1);
    } else {
      pattern[0] = __builtin_shufflevector(four, four, 0, 1, 2, 0, 1, 2, 0, 1);
      pattern[1] = __builtin_shufflevector(four, four, 2, 0, 1, 2, 0, 1, 2, 0);
      pattern[2] = __builtin_shufflevector(four, four, 1, 2, 0, 1, 2, 0, 1, 2);
    }
#else
    if constexpr (D == 2) {
      pattern[0] = __builtin_shufflevector(four, four, 0, 1, 0, 1);
    } else {
      pattern[0] = __builtin_shufflevector(four, four, 0, 1, 2, 0);
      pattern[1] = __builtin_shufflevector(four, four, 1, 2, 0, 1);
      pattern[2] = __builtin_shufflevector(four, four, 2, 0, 1, 2);
    }
#endif
  };
  constexpr int patterns = D == 2 ? 1 : 3;
  VG pattern[patterns], value;
  spread(stencil.sums, pattern);
  for (int v = 0; v < D * D; ++v)
    load(value, P + i * D * D + static_cast<std::uint64_t>(group * v)),
        sum[v] = value * pattern[v % patterns];
  if constexpr (Hourglass)
    for (int v = 0; v < D; ++v)
      load(value, q + i * D + static_cast<std::uint64_t>(group * v)), held[v] = value * stencil.sums[D];
  const double* w = stencil.backward;
  for (std::uint32_t m = 0; m < stencil.n; ++m, w += D + 1) {
    const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) + stencil.offset[m];
    spread(w, pattern);
    for (int v = 0; v < D * D; ++v)
      load(value, P + j * D * D + group * v), sum[v] -= value * pattern[v % patterns];
    if constexpr (Hourglass)
      for (int v = 0; v < D; ++v) load(value, q + j * D + group * v), held[v] -= value * w[D];
  }
  double stress[group * D * D], control[group * D] = {};
  std::memcpy(stress, sum, sizeof stress);
  if constexpr (Hourglass) std::memcpy(control, held, sizeof control);
  for (int k = 0; k < group * D; ++k) {
    double f = -control[k];
    for (int c = 0; c < D; ++c) f += stress[k * D + c];
    out[i * D + static_cast<std::size_t>(k)] = factor * f;
  }
}

// -- particles begin ... end - 1 with one stencil ------------------------------------------------------------------

// Calls many(i) for particles i ... i + group - 1, or one(i); the last group overlaps the one before where they do not
// come out even, which computes the same numbers twice.
template <class Many, class One>
void in_groups(std::uint64_t begin, std::uint64_t end, const Many& many, const One& one) {
  std::uint64_t i = begin;
  if (end - begin < group) {
    for (; i < end; ++i) one(i);
    return;
  }
  for (; i + group <= end; i += group) many(i);
  if (i < end) many(end - group);
}

template <int D>
void deform_run(const Stencil& stencil, std::uint64_t begin, std::uint64_t end, const double* x,
                double stiffness, double* F, double* q) {
  in_groups(
      begin, end, [&](std::uint64_t i) { deformations<D>(stencil, x, stiffness, i, F, q); },
      [&](std::uint64_t i) {
        const auto [gradient, residual] = deformation<D>(stencil, x, i);
        std::memcpy(F + i * D * D, gradient.e, sizeof gradient.e);
        for (int a = 0; a < D; ++a) q[i * D + static_cast<std::size_t>(a)] = stiffness * residual[a];
      });
}

template <int D, bool Hourglass>
void force_run(const Stencil& stencil, std::uint64_t begin, std::uint64_t end, const double* P,
               const double* q, double factor, double* out) {
  in_groups(
      begin, end, [&](std::uint64_t i) { forces<D, Hourglass>(stencil, P, q, factor, i, out); },
      [&](std::uint64_t i) {
        const Vec<D> f = force<D, Hourglass>(stencil, P, q, i);
        for (int a = 0; a < D; ++a) out[i * D + static_cast<std::size_t>(a)] = factor * f[a];
      });
}

}  // namespace shoal::solid
