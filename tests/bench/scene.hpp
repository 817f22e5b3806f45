// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// 200 000 particles on a jittered lattice in 3D, in the order in which a run keeps them, with the kernel's own
// neighbour lists. Wendland C2, h = 1.3 dx, cut-off 2.6 dx.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kernel/neighbours/aligned_buffer.hpp"
#include "kernel/neighbours/neighbour_grid.hpp"
#include "kernel/neighbours/neighbour_list.hpp"
#include "shoal/abi.h"
#include "shoal/operator.hpp"
#include "tests/bench/one_pass.hpp"

namespace shoal::bench {

class Scene {
 public:
  static constexpr double dx = 0.01, smoothing_length = 1.3 * dx, cutoff = 2.6 * dx;

  Scene();
  std::uint64_t size() const { return n_; }
  std::uint64_t n_pairs() const { return list_.n_pairs(); }
  const Constants& constants() const { return constants_; }
  const kernel::NeighbourList& list() const { return list_; }

  /// Components interleaved; made and filled with zeros if there is no such field.
  double* field(const std::string& name, std::size_t components);
  /// Sorts the particles into cells and builds their lists, as each advection step of a run does.
  void rebuild();
  /// Zeros, so that nothing is left of what another way of computing wrote.
  void clear_results();

  /// An operator of this scene, with itself as neighbours.
  Target target() const;
  /// Hands the scene's arrays to what takes a shoal_binding.
  template <class Bind>
  void bind(const std::vector<shoal_access>& accesses, const Bind& take) {
    std::vector<shoal_field> views;
    for (const shoal_access& access : accesses) {
      const std::uint32_t components = access.rank == SHOAL_SCALAR ? 1 : 3;
      views.push_back({sizeof(shoal_field), components, field(access.field, components), n_, n_, nullptr});
    }
    const shoal_neighbours lists{sizeof(shoal_neighbours), 0,  list_.offsets(), list_.counts(),
                                 list_.indices(),          n_, cutoff,          1};
    take(shoal_binding{sizeof(shoal_binding), 3, n_, views.data(), &lists, views.data()});
  }

 private:
  void place_particles();
  void fill_fields();

  std::uint64_t n_ = 0;
  Constants constants_;
  std::map<std::string, kernel::AlignedBuffer<double>> fields_;
  kernel::NeighbourGrid grid_;
  kernel::NeighbourList list_;
};

}  // namespace shoal::bench
