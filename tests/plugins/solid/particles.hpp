// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies for the tests of the solid plugin: boxes of particles, on a lattice or disordered.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "reference_weights.hpp"
#include "shoal/testing.hpp"

namespace solid_test {

constexpr double dx = 0.1;

// n particles along each axis (n_depth along the last one), each off its place by up to `disorder` spacings, with the
// normal and the distance of the box's surface.
inline shoal::testing::Body box(int dimensions, int n, double disorder) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-disorder * dx, disorder * dx);
  std::vector<double> x, normal, distance;
  const int depth = dimensions == 3 ? n : 1;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int c = 0; c < depth; ++c) {
        const int place[3] = {a, b, c};
        double nearest = HUGE_VAL;
        int axis = 0;
        for (int k = 0; k < dimensions; ++k) {
          x.push_back((place[k] + 0.5) * dx + off(random));
          const double gap = std::min(x.back(), n * dx - x.back());
          if (gap < nearest) nearest = gap, axis = k;
        }
        const double* own = x.data() + x.size() - static_cast<std::size_t>(dimensions);
        for (int k = 0; k < dimensions; ++k)
          normal.push_back(k != axis ? 0.0 : own[k] < 0.5 * n * dx ? -1.0 : 1.0);
        distance.push_back(-nearest);
      }
  shoal::testing::Body body(dimensions, x);
  body["reference_position"] = x;
  body["normal"] = normal;
  body["signed_distance"] = distance;
  body.set("volume", std::pow(dx, dimensions));
  return body;
}

inline shoal::solid::ReferenceSettings settings() { return {true, 1.15 * dx, dx, 0.01, true}; }

// The neighbours of a body in the reference configuration, by looking at all pairs.
struct Neighbours {
  shoal::testing::impl::Rows rows;
  shoal_neighbours list{};
  explicit Neighbours(shoal::testing::Body& body)
      : rows(shoal::testing::impl::all_pairs(body, body, 2.0 * settings().smoothing_length)) {
    list.size = sizeof list;
    list.offsets = rows.offsets.data();
    list.counts = rows.counts.data();
    list.indices = rows.indices.data();
    list.n_rows = body.size();
    list.cutoff = 2.0 * settings().smoothing_length;
  }
};

inline shoal::solid::ReferenceGeometry geometry(shoal::testing::Body& body) {
  return {body["reference_position"].data(), body["volume"].data(), body["normal"].data(),
          body["signed_distance"].data()};
}

// The two sums of stencils.hpp for one particle, in plain loops.
template <int D>
struct Deformation {
  shoal::Mat<D> gradient;
  shoal::Vec<D> residual;
};
template <int D>
Deformation<D> deformation(const shoal::solid::Stencil& stencil, const double* x, std::size_t i) {
  Deformation<D> result{};
  for (std::uint32_t m = 0; m < stencil.n; ++m) {
    const double* w = stencil.forward + m * (D + 1);
    const std::size_t j = i + static_cast<std::size_t>(stencil.offset[m]);
    for (std::size_t r = 0; r < D; ++r) {
      const double difference = x[j * D + r] - x[i * D + r];
      for (int c = 0; c < D; ++c) result.gradient(static_cast<int>(r), c) += difference * w[c];
      result.residual.e[r] -= difference * w[D];
    }
  }
  return result;
}
template <int D>
shoal::Vec<D> force(const shoal::solid::Stencil& stencil, const double* P, const double* q, bool hourglass,
                    std::size_t i) {
  shoal::Vec<D> f{};
  for (std::uint32_t m = 0; m < stencil.n; ++m) {
    const double *here = stencil.forward + m * (D + 1), *there = stencil.backward + m * (D + 1);
    const std::size_t j = i + static_cast<std::size_t>(stencil.offset[m]);
    for (std::size_t r = 0; r < D; ++r) {
      for (std::size_t c = 0; c < D; ++c)
        f.e[r] += P[i * D * D + r * D + c] * here[c] - P[j * D * D + r * D + c] * there[c];
      if (hourglass) f.e[r] -= q[i * D + r] * here[D] - q[j * D + r] * there[D];
    }
  }
  return f;
}

}  // namespace solid_test
