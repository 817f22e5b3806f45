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

}  // namespace solid_test
