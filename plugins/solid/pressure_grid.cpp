// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "pressure_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace shoal::solid {

void PressureGrid::build(int dimensions, std::uint64_t n, const double* position, const double* volume,
                         double spacing) {
  const auto d = static_cast<std::size_t>(dimensions);
  const double size = 2.0 * spacing;
  corners_ = std::size_t{1} << d;
  // Nodes lie on the surfaces of a box of particles.
  std::array<double, 3> origin{};
  for (std::size_t a = 0; a < d; ++a) {
    origin[a] = HUGE_VAL;
    for (std::uint64_t i = 0; i < n; ++i)
      origin[a] = std::min(origin[a], position[i * d + a] - 0.5 * spacing);
  }
  std::map<std::array<std::int64_t, 3>, std::uint32_t> known;
  node_.clear(), weight_.clear();
  for (std::uint64_t i = 0; i < n; ++i) {
    std::array<std::int64_t, 3> cell{};
    std::array<double, 3> fraction{};
    for (std::size_t a = 0; a < d; ++a) {
      const double place = (position[i * d + a] - origin[a]) / size, below = std::floor(place);
      cell[a] = static_cast<std::int64_t>(below);
      fraction[a] = place - below;
    }
    for (std::size_t corner = 0; corner < corners_; ++corner) {
      std::array<std::int64_t, 3> node = cell;
      double weight = 1.0;
      for (std::size_t a = 0; a < d; ++a) {
        const bool upper = (corner >> a & 1) != 0;
        node[a] += upper;
        weight *= upper ? fraction[a] : 1.0 - fraction[a];
      }
      node_.push_back(known.try_emplace(node, static_cast<std::uint32_t>(known.size())).first->second);
      weight_.push_back(weight);
    }
  }
  volume_.assign(known.size(), 0.0);
  begin_.assign(known.size() + 1, 0);
  for (std::size_t k = 0; k < node_.size(); ++k) {
    ++begin_[node_[k] + 1];
    volume_[node_[k]] += volume[k / corners_] * weight_[k];
  }
  for (std::size_t c = 0; c + 1 < begin_.size(); ++c) begin_[c + 1] += begin_[c];
  particle_.resize(node_.size()), share_.resize(node_.size());
  std::vector<std::uint64_t> place(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const std::uint64_t to = place[node_[k]]++, i = k / corners_;
    particle_[to] = static_cast<std::uint32_t>(i);
    // A node that touches its particles with nothing at all does nothing.
    share_[to] = volume_[node_[k]] > 0.0 ? volume[i] * weight_[k] / volume_[node_[k]] : 1.0;
  }
}

void PressureGrid::means(const double* values, double* out) const {
  for (std::size_t c = 0; c < n_nodes(); ++c) {
    double sum = 0;
    for (std::uint64_t k = begin_[c]; k < begin_[c + 1]; ++k) sum += share_[k] * values[particle_[k]];
    out[c] = sum;
  }
}

}  // namespace shoal::solid
