// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The two sums over neighbours of the total Lagrangian scheme, with stored weights,
//   F_i = sum_j (x_j - x_i) (x) G_ij,   r_i = -sum_j (x_j - x_i) psi_ij,
//   f_i = sum_j [P_i G_ij - V_j / V_i P_j G_ji] - sum_j [q_i psi_ij - V_j / V_i q_j psi_ji],
// the second being the exact transpose of the first, so that momentum, angular momentum and energy are conserved; q is
// the derivative of the hourglass energy with respect to the residual r.
//
// The neighbours of a particle and their weights are a stencil: differences of numbers j - i, and the weights. On a
// lattice, particles that stand next to each other in the body's order have the same one, so SIMD runs over a group of
// such particles, whose neighbours stand next to each other too: loads without gathering, weights from cache, no sum
// across lanes before the end. All others (at edges, or disordered) are put together, each in a lane of its own with its
// own neighbours and weights, which are gathered. Loads of 4 numbers reach one or two beyond a vector or a weight; arrays
// are padded, and what is read there is not used.
//
// Which particles go together is fixed by the stencils and the kernel's chunks, and each lane does what it would do
// in any company, so results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "interleave.hpp"
#include "shoal/pack_scatter.hpp"
#include "shoal/vec.hpp"

namespace shoal::solid {

// D + 1 numbers a neighbour: G, then psi; of i, and of the neighbours towards i times V_j / V_i. Behind the first
// `controlled` neighbours psi is zero in both directions.
struct Stencil {
  std::uint32_t n, controlled, pattern;
  std::uint64_t first;         // pair, in the arrays of all stencils
  const std::int32_t* offset;  // j - i
  const double *forward, *backward;
  const double* sums;  // of `forward`
};

// Where the numbers of all stencils stand.
struct StencilArrays {
  const std::int32_t* offset;
  const double *forward, *backward, *sums;
  std::uint32_t none;  // a pair with weights of zero
};

// -- a group of particles, one after the other, with the same stencil ----------------------------------------------

inline void load(VG& v, const double* p) { std::memcpy(&v, p, sizeof v); }
inline void store(const VG& v, double* p) { std::memcpy(p, &v, sizeof v); }

// F (row by row) and, where there is hourglass control, residual times `stiffness` of particles i ... i + group - 1.
template <int D, bool Hourglass>
void deformations(const Stencil& stencil, const double* x, double stiffness, std::uint64_t i, double* F,
                  double* q) {
  constexpr int sums = Hourglass ? D + 1 : D;
  VG own[D], sum[sums][D];
  for (int v = 0; v < D; ++v) {
    load(own[v], x + i * D + static_cast<std::uint64_t>(group * v));
    for (int c = 0; c < sums; ++c) sum[c][v] = VG{};
  }
  const auto add = [&]<int terms>(std::uint32_t begin, std::uint32_t end) {
    const double* w = stencil.forward + begin * (D + 1);
    for (std::uint32_t m = begin; m < end; ++m, w += D + 1) {
      const double* theirs = x + (static_cast<std::ptrdiff_t>(i) + stencil.offset[m]) * D;
      for (int v = 0; v < D; ++v) {
        VG difference;
        load(difference, theirs + group * v);
        difference -= own[v];
        for (int c = 0; c < terms; ++c) sum[c][v] += difference * w[c];
      }
    }
  };
  const std::uint32_t controlled = Hourglass ? stencil.controlled : 0;
  add.template operator()<sums>(0, controlled);
  add.template operator()<D>(controlled, stencil.n);
  double* gradient = F + i * D * D;
  for (int v = 0; v < D; ++v) {
    VG columns[D], rows[D];
    for (int c = 0; c < D; ++c) columns[c] = sum[c][v];
    interleave(columns, rows);
    for (int k = 0; k < D; ++k) store(rows[k], gradient + group * (v * D + k));
    if constexpr (Hourglass) store(-stiffness * sum[D][v], q + i * D + static_cast<std::uint64_t>(group * v));
  }
}

// Weights of D directions over lanes that hold the components of P one after the other: they repeat with period D.
template <int D>
void repeat(const double* w, VG* pattern) {
  typedef double V4 __attribute__((vector_size(32)));
  V4 four;
  std::memcpy(&four, w, sizeof four);
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
}

// Force per reference volume, times `factor`, on particles i ... i + group - 1.
template <int D, bool Hourglass>
void forces(const Stencil& stencil, const double* P, const double* q, double factor, std::uint64_t i,
            double* out) {
  constexpr int patterns = D == 2 ? 1 : 3;
  VG sum[D * D], held[D], pattern[patterns], value;
  repeat<D>(stencil.sums, pattern);
  for (int v = 0; v < D * D; ++v)
    load(value, P + i * D * D + static_cast<std::uint64_t>(group * v)),
        sum[v] = value * pattern[v % patterns];
  if constexpr (Hourglass)
    for (int v = 0; v < D; ++v)
      load(value, q + i * D + static_cast<std::uint64_t>(group * v)), held[v] = value * stencil.sums[D];
  const auto add = [&]<bool Controlled>(std::uint32_t begin, std::uint32_t end) {
    const double* w = stencil.backward + begin * (D + 1);
    for (std::uint32_t m = begin; m < end; ++m, w += D + 1) {
      const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) + stencil.offset[m];
      repeat<D>(w, pattern);
      for (int v = 0; v < D * D; ++v)
        load(value, P + j * D * D + group * v), sum[v] -= value * pattern[v % patterns];
      if constexpr (Controlled)
        for (int v = 0; v < D; ++v) load(value, q + j * D + group * v), held[v] -= value * w[D];
    }
  };
  const std::uint32_t controlled = Hourglass ? stencil.controlled : 0;
  if constexpr (Hourglass) add.template operator()<true>(0, controlled);
  add.template operator()<false>(controlled, stencil.n);
  for (int v = 0; v < D; ++v) {
    VG f;
    if constexpr (D == 2)
      f = row_sums(sum[2 * v], sum[2 * v + 1]);
    else
      f = row_sums(sum[3 * v], sum[3 * v + 1], sum[3 * v + 2]);
    if constexpr (Hourglass) f -= held[v];
    store(factor * f, out + i * D + static_cast<std::uint64_t>(group * v));
  }
}

// -- particles with a lane each ------------------------------------------------------------------------------------

class Loners {
 public:
  bool full() const { return size_ == lanes; }
  bool empty() const { return size_ == 0; }
  void add(std::uint64_t i, const Stencil& stencil) {
    lane_[size_++] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(stencil.first), stencil.n,
                      stencil.controlled, stencil.pattern};
  }
  // Lanes that are left over repeat the last particle, which changes nothing.
  void close() {
    least_ = UINT32_MAX, most_ = controlled_ = 0;
    for (int k = 0; k < lanes; ++k) {
      if (k >= size_) lane_[k] = lane_[k - 1];
      i_[k] = lane_[k].i, pattern_[k] = lane_[k].pattern;
      least_ = std::min(least_, lane_[k].n), most_ = std::max(most_, lane_[k].n);
      controlled_ = std::max(controlled_, lane_[k].controlled);
    }
    size_ = 0;
  }
  IndexPack particles() const { return IndexPack::load(i_); }
  IndexPack patterns() const { return IndexPack::load(pattern_); }

  // function<whether any has a weight of the hourglass residual>(neighbours, where their weights begin); lanes that have
  // no more neighbours get their own particle and weights of zero.
  template <int D, bool Hourglass, class Function>
  void for_each_neighbour(const StencilArrays& arrays, const Function& function) const {
    const std::uint32_t controlled = Hourglass ? controlled_ : 0;
    for_neighbours<D, Hourglass>(0, controlled, arrays, function);
    for_neighbours<D, false>(controlled, most_, arrays, function);
  }

 private:
  template <int D, bool Controlled, class Function>
  void for_neighbours(std::uint32_t m, std::uint32_t end, const StencilArrays& arrays,
                      const Function& function) const {
    std::uint32_t j[lanes], at[lanes];
    for (; m < std::min(end, least_); ++m) {
#pragma GCC unroll 8
      for (int k = 0; k < lanes; ++k) {
        const std::uint32_t pair = lane_[k].first + m;
        j[k] = lane_[k].i + static_cast<std::uint32_t>(arrays.offset[pair]);
        at[k] = pair * (D + 1);
      }
      function.template operator()<Controlled>(IndexPack::load(j), IndexPack::load(at));
    }
    for (; m < end; ++m) {
      for (int k = 0; k < lanes; ++k) {
        const bool has = m < lane_[k].n;
        const std::uint32_t pair = has ? lane_[k].first + m : arrays.none;
        j[k] = lane_[k].i + (has ? static_cast<std::uint32_t>(arrays.offset[pair]) : 0u);
        at[k] = pair * (D + 1);
      }
      function.template operator()<Controlled>(IndexPack::load(j), IndexPack::load(at));
    }
  }

  struct Lane {
    std::uint32_t i, first, n, controlled, pattern;
  };
  Lane lane_[lanes];
  std::uint32_t i_[lanes], pattern_[lanes], least_ = 0, most_ = 0, controlled_ = 0;
  int size_ = 0;
};

template <int D, bool Hourglass>
void deformations(const StencilArrays& arrays, const Loners& loners, const double* x, double stiffness,
                  double* F, double* q) {
  constexpr int sums = Hourglass ? D + 1 : D;
  const IndexPack i = loners.particles();
  Pack own[D], theirs[D], w[D + 1], sum[D][sums];
  gather_tuple<D>(x, i, own);
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < sums; ++c) sum[r][c] = 0.0;
  const auto add = [&]<bool Controlled>(IndexPack j, IndexPack at) {
    gather_tuple<D>(x, j, theirs);
    gather_tuple<D + 1, 1>(arrays.forward, at, w);
    for (int r = 0; r < D; ++r) {
      const Pack difference = theirs[r] - own[r];
      for (int c = 0; c < (Controlled ? sums : D); ++c) sum[r][c] += difference * w[c];
    }
  };
  loners.for_each_neighbour<D, Hourglass>(arrays, add);
  Pack gradient[D * D], held[D];
  for (int r = 0; r < D; ++r) {
    for (int c = 0; c < D; ++c) gradient[r * D + c] = sum[r][c];
    if constexpr (Hourglass) held[r] = -stiffness * sum[r][D];
  }
  scatter_tuple<D * D>(gradient, i, F);
  if constexpr (Hourglass) scatter_tuple<D>(held, i, q);
}

template <int D, bool Hourglass>
void forces(const StencilArrays& arrays, const Loners& loners, const double* P, const double* q,
            double factor, double* out) {
  const IndexPack i = loners.particles();
  Pack stress[D * D], control[D], w[D + 1], sum[D][D + 1];
  const auto look = [&]<bool Controlled>(IndexPack j) {
    gather_tuple<D * D>(P, j, stress);
    if constexpr (Controlled) gather_tuple<D>(q, j, control);
  };
  look.template operator()<Hourglass>(i);
  gather_tuple<D + 1>(arrays.sums, loners.patterns(), w);
  for (int r = 0; r < D; ++r) {
    for (int c = 0; c < D; ++c) sum[r][c] = stress[r * D + c] * w[c];
    if constexpr (Hourglass) sum[r][D] = control[r] * w[D];
  }
  const auto add = [&]<bool Controlled>(IndexPack j, IndexPack at) {
    look.template operator()<Controlled>(j);
    gather_tuple<D + 1, 1>(arrays.backward, at, w);
    for (int r = 0; r < D; ++r) {
      for (int c = 0; c < D; ++c) sum[r][c] -= stress[r * D + c] * w[c];
      if constexpr (Controlled) sum[r][D] -= control[r] * w[D];
    }
  };
  loners.for_each_neighbour<D, Hourglass>(arrays, add);
  Pack f[D];
  for (int r = 0; r < D; ++r) {
    f[r] = sum[r][0];
    for (int c = 1; c < D; ++c) f[r] += sum[r][c];
    if constexpr (Hourglass) f[r] -= sum[r][D];
    f[r] *= factor;
  }
  scatter_tuple<D>(f, i, out);
}

}  // namespace shoal::solid
