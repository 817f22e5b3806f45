// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Multilinear hat functions N_c on a grid of twice the spacing of the particles, in the reference configuration, for the
// pressure of nearly incompressible solids (volume_averaging.hpp):
//   mean_c = sum_i V_i N_ci f_i / M_c,   M_c = sum_i V_i N_ci;   at a particle sum_c N_ci f_c,   sum_c N_ci = 1.
#pragma once

#include <cstdint>
#include <vector>

namespace shoal::solid {

class PressureGrid {
 public:
  bool built() const { return corners_ > 0; }
  void build(int dimensions, std::uint64_t n, const double* position, const double* volume, double spacing);

  std::size_t n_nodes() const { return begin_.size() - 1; }
  // Means of values at particles; always in the same order.
  void means(const double* values, double* out) const;
  // Value at particle i of a function given at the nodes.
  double at(std::uint64_t i, const double* nodes) const {
    double sum = 0;
    for (std::size_t k = i * corners_; k < (i + 1) * corners_; ++k) sum += weight_[k] * nodes[node_[k]];
    return sum;
  }
  // sum_c N_ci f(c)
  template <class Function>
  double sum_at(std::uint64_t i, const Function& f) const {
    double sum = 0;
    for (std::size_t k = i * corners_; k < (i + 1) * corners_; ++k) sum += weight_[k] * f(node_[k]);
    return sum;
  }
  // function(i, V_i N_ci / M_c) for the particles of node c.
  template <class Function>
  void for_each_particle(std::size_t c, const Function& function) const {
    for (std::uint64_t k = begin_[c]; k < begin_[c + 1]; ++k) function(particle_[k], share_[k]);
  }
  double volume(std::size_t c) const { return volume_[c]; }  // M_c

 private:
  std::size_t corners_ = 0;           // of a cell
  std::vector<std::uint32_t> node_;   // of particle i: corners_ from i corners_ on
  std::vector<double> weight_;        // N_ci
  std::vector<std::uint64_t> begin_;  // of node c: particles and V_i N_ci / M_c
  std::vector<std::uint32_t> particle_;
  std::vector<double> share_, volume_;
};

}  // namespace shoal::solid
