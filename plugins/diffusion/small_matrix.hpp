// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Matrices of up to ten rows, solved once for each particle. (Eigen would do, but with gcc 12 and AVX-512 it does not
// compile without warnings, and takes ten times as long to.)
#pragma once

#include <array>
#include <cmath>
#include <utility>

namespace shoal::diffusion {

template <int N>
using SmallVector = std::array<double, N>;

template <int N>
struct SmallMatrix {
  std::array<double, N * N> e{};
  double& operator()(int row, int column) { return e[static_cast<std::size_t>(row * N + column)]; }
  double operator()(int row, int column) const { return e[static_cast<std::size_t>(row * N + column)]; }
};

// Inverts in place by Gauss-Jordan elimination with row pivots. Returns the smallest pivot over the largest one, 0 if
// there is no inverse.
template <int N>
double invert(SmallMatrix<N>& a) {
  SmallMatrix<N> inverse;
  for (int k = 0; k < N; ++k) inverse(k, k) = 1.0;
  double smallest = HUGE_VAL, largest = 0.0;
  for (int k = 0; k < N; ++k) {
    int best = k;
    for (int r = k + 1; r < N; ++r)
      if (std::abs(a(r, k)) > std::abs(a(best, k))) best = r;
    const double pivot = a(best, k);
    smallest = std::min(smallest, std::abs(pivot));
    largest = std::max(largest, std::abs(pivot));
    if (pivot == 0.0) return 0.0;
    for (int c = 0; c < N; ++c) {
      std::swap(a(k, c), a(best, c));
      std::swap(inverse(k, c), inverse(best, c));
    }
    const double factor = 1.0 / pivot;
    for (int c = 0; c < N; ++c) a(k, c) *= factor, inverse(k, c) *= factor;
    for (int r = 0; r < N; ++r) {
      const double f = a(r, k);
      if (r == k || f == 0.0) continue;
      for (int c = 0; c < N; ++c) a(r, c) -= f * a(k, c), inverse(r, c) -= f * inverse(k, c);
    }
  }
  a = inverse;
  return smallest / largest;
}

}  // namespace shoal::diffusion
