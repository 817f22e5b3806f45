// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The two sums over neighbours of the total Lagrangian scheme, with stored weights.
//
// SIMD runs over the components of a neighbour's matrices, not over neighbours as in the SDK's loops: then nothing is
// gathered and nothing summed across lanes. A pair costs one load and D fused multiply-adds for F and the hourglass
// residual together, D + 1 loads for the force (measured: see the README). Loads of 4 numbers reach one or two beyond a
// vector or a weight; arrays are padded, and the lanes are not used.
#pragma once

#include <cstring>

#include "reference_weights.hpp"
#include "shoal/vec.hpp"

namespace shoal::solid {

typedef double V4 __attribute__((vector_size(32)));
typedef double V2 __attribute__((vector_size(16)));

inline V4 load4(const double* p) {
  V4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline V2 load2(const double* p) {
  V2 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline V4 twice(V2 a) { return V4{a[0], a[1], a[0], a[1]}; }

// Row i of a neighbour list.
struct Row {
  const std::uint32_t* j;
  std::uint32_t n;
};
inline Row row_of(const shoal_neighbours& list, std::uint64_t i) {
  return {list.indices + list.offsets[i], list.counts[i]};
}

template <int D>
struct Deformation {
  Mat<D> gradient;
  Vec<D> residual;  // of the hourglass control
};

// sum_j (x_j - x_i) (x) G_ij and -sum_j (x_j - x_i) psi_ij. Two accumulators each, to hide the latency of the sums.
template <int D>
Deformation<D> deformation(const Row& row, const double* weights, const double* x, std::uint64_t i) {
  constexpr std::size_t S = D + 1;
  const double* own = x + i * D;
  V4 sum[D] = {}, other[D] = {};
  std::uint32_t m = 0;
  for (; m + 2 <= row.n; m += 2, weights += 2 * S) {
    const double *a = x + std::size_t{row.j[m]} * D, *b = x + std::size_t{row.j[m + 1]} * D;
    const V4 wa = load4(weights), wb = load4(weights + S);
    for (int r = 0; r < D; ++r) {
      sum[r] += (a[r] - own[r]) * wa;
      other[r] += (b[r] - own[r]) * wb;
    }
  }
  if (m < row.n) {
    const double* a = x + std::size_t{row.j[m]} * D;
    const V4 wa = load4(weights);
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

// sum_j [P_j G'_ji - q_j psi'_ji], the weights being those of j towards i times V_j / V_i.
template <bool Hourglass>
Vec<3> force_of_neighbours(const Row& row, const double* weights, const double* P, const double* q, Vec<3>) {
  V4 sum[3] = {}, held{};
  for (std::uint32_t m = 0; m < row.n; ++m, weights += 4) {
    const double* p = P + std::size_t{row.j[m]} * 9;
    const V4 w = load4(weights);
    for (int r = 0; r < 3; ++r) sum[r] += load4(p + 3 * r) * w;
    if constexpr (Hourglass) held += load4(q + std::size_t{row.j[m]} * 3) * weights[3];
  }
  Vec<3> result;
  for (int r = 0; r < 3; ++r) result[r] = sum[r][0] + sum[r][1] + sum[r][2] - held[r];
  return result;
}
template <bool Hourglass>
Vec<2> force_of_neighbours(const Row& row, const double* weights, const double* P, const double* q, Vec<2>) {
  V4 sum{}, other{};
  V2 held{};
  const auto add = [&](std::uint32_t m, const double* w, V4& to) {
    const std::size_t j = row.j[m];
    to += load4(P + 4 * j) * twice(load2(w));
    if constexpr (Hourglass) held += load2(q + 2 * j) * w[2];
  };
  std::uint32_t m = 0;
  for (; m + 2 <= row.n; m += 2, weights += 6) {
    add(m, weights, sum);
    add(m + 1, weights + 3, other);
  }
  if (m < row.n) add(m, weights, sum);
  sum += other;
  return {sum[0] + sum[1] - held[0], sum[2] + sum[3] - held[1]};
}

// Force per reference volume on particle i, N/m3: the exact transpose of `deformation`, so that momentum, angular
// momentum and energy are conserved,
//   f_i = sum_j [P_i G_ij - V_j / V_i P_j G_ji] - sum_j [q_i psi_ij - V_j / V_i q_j psi_ji],
// with q the stress-like derivative of the hourglass energy with respect to the residual.
template <int D, bool Hourglass>
Vec<D> force(const Row& row, const double* weights, const double* sums, const double* P, const double* q,
             std::uint64_t i) {
  Vec<D> f = -force_of_neighbours<Hourglass>(row, weights, P, q, Vec<D>{});
  const double *own = P + i * D * D, *own_q = q + i * D;
  for (int r = 0; r < D; ++r) {
    for (int k = 0; k < D; ++k) f[r] += own[r * D + k] * sums[k];
    if constexpr (Hourglass) f[r] -= own_q[r] * sums[D];
  }
  return f;
}

}  // namespace shoal::solid
