// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The slow and obvious neighbour search that the fast one is held against, and clouds of points to try both on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "kernel/neighbours/neighbour_list.hpp"

namespace shoal::kernel::testing {

/// Interleaved positions with their number of dimensions.
struct Cloud {
  int dimensions = 3;
  std::vector<double> x;

  std::size_t size() const { return x.size() / static_cast<std::size_t>(dimensions); }
  Positions positions() const { return {x.data(), size(), dimensions}; }
  void add(const std::vector<double>& point) { x.insert(x.end(), point.begin(), point.end()); }
};

inline Cloud random_cloud(int dimensions, std::size_t n, double lower, double upper, unsigned seed) {
  Cloud cloud{dimensions, {}};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(lower, upper);
  cloud.x.resize(n * static_cast<std::size_t>(dimensions));
  for (double& c : cloud.x) c = uniform(random);
  return cloud;
}

/// A box of m^D points, each moved by up to `jitter` of the spacing.
inline Cloud jittered_lattice(int dimensions, int m, double spacing, double jitter, unsigned seed) {
  Cloud cloud{dimensions, {}};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-jitter, jitter);
  for (int k = 0; k < (dimensions == 3 ? m : 1); ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) {
        const int cell[3] = {i, j, k};
        for (int a = 0; a < dimensions; ++a) cloud.x.push_back((cell[a] + uniform(random)) * spacing);
      }
  return cloud;
}

/// For each target the sources nearer than the cut-off, in ascending order, by trying all pairs.
inline std::vector<std::vector<std::uint32_t>> all_pairs(const Cloud& targets, std::size_t n_targets,
                                                         const Cloud& sources, double cutoff,
                                                         bool same_body) {
  const auto d = static_cast<std::size_t>(targets.dimensions);
  std::vector<std::vector<std::uint32_t>> rows(n_targets);
  for (std::size_t i = 0; i < n_targets; ++i)
    for (std::size_t j = 0; j < sources.size(); ++j) {
      if (same_body && i == j) continue;
      double r2 = 0.0;
      for (std::size_t a = 0; a < d; ++a) {
        const double difference = targets.x[i * d + a] - sources.x[j * d + a];
        r2 += difference * difference;
      }
      if (r2 < cutoff * cutoff) rows[i].push_back(static_cast<std::uint32_t>(j));
    }
  return rows;
}

/// Rows of a list as they stand.
inline std::vector<std::vector<std::uint32_t>> rows_of(const NeighbourList& list) {
  std::vector<std::vector<std::uint32_t>> rows(list.n_rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t* row = list.indices() + list.offsets()[i];
    rows[i].assign(row, row + list.counts()[i]);
  }
  return rows;
}

inline std::vector<std::vector<std::uint32_t>> sorted_rows(std::vector<std::vector<std::uint32_t>> rows) {
  for (auto& row : rows) std::sort(row.begin(), row.end());
  return rows;
}

/// The number of promises of the compressed layout that a list breaks: alignment, padding with the last neighbour,
/// consecutive rows, sums.
inline int layout_errors(const NeighbourList& list) {
  int errors = reinterpret_cast<std::uintptr_t>(list.indices()) % 64 != 0;
  std::uint64_t end = 0, pairs = 0;
  for (std::size_t i = 0; i < list.n_rows(); ++i) {
    const std::uint64_t begin = list.offsets()[i];
    const std::uint64_t count = list.counts()[i];
    const std::uint64_t padded = (count + 7) / 8 * 8;
    errors += begin != end;
    end = begin + padded;
    pairs += count;
    for (std::uint64_t k = begin + count; k < end; ++k)
      errors += list.indices()[k] != list.indices()[begin + count - 1];
  }
  errors += list.offsets()[list.n_rows()] != end;
  errors += list.n_pairs() != pairs;
  return errors;
}

}  // namespace shoal::kernel::testing
