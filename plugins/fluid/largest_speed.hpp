// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The largest |v| of a block of particles, which limits steps.
#pragma once

#include <cmath>
#include <cstdint>

namespace shoal::fluid {

// max |v_i| for begin <= i < end, with v interleaved; NaN if one of them is. Eight particles at a time, without branches.
template <int D>
double largest_speed(const double* v, std::uint64_t begin, std::uint64_t end) {
  constexpr int width = 8;
  double largest[width] = {}, sum = 0.0;  // of squares; the sum is NaN where one of them is
  const auto take = [&](std::uint64_t i, double& at) {
    double square = 0.0;
    for (int a = 0; a < D; ++a)
      square += v[i * D + static_cast<std::uint64_t>(a)] * v[i * D + static_cast<std::uint64_t>(a)];
    at = square > at ? square : at;
    return square;
  };
  std::uint64_t i = begin;
  double sums[width] = {};
  for (; i + width <= end; i += width)
    for (int k = 0; k < width; ++k) sums[k] += take(i + static_cast<std::uint64_t>(k), largest[k]);
  for (; i < end; ++i) sum += take(i, largest[0]);
  double square = 0.0;
  for (int k = 0; k < width; ++k) {
    square = largest[k] > square ? largest[k] : square;
    sum += sums[k];
  }
  return sum == sum ? std::sqrt(square) : sum;
}

}  // namespace shoal::fluid
