// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Relations between bodies and their renewal: wrap, sort, images, lists.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/neighbours/neighbour_grid.hpp"
#include "kernel/neighbours/neighbour_list.hpp"
#include "kernel/particles/body.hpp"
#include "kernel/particles/domain.hpp"

namespace shoal::kernel {

/// A pair of bodies, or a body with itself, and a cut-off: the unit of neighbour search.
struct Relation {
  std::uint32_t body = 0;        ///< whose particles the rows are
  std::uint32_t neighbours = 0;  ///< body among whose particles they look
  shoal_configuration configuration = SHOAL_CURRENT;
  double cutoff = 0.0;  ///< m; the largest of all requests
  NeighbourList list;
  std::uint64_t builds = 0;
  /// Of a reference list across boundaries: its indices with the images where they stand now.
  AlignedBuffer<std::uint32_t> moved_indices;
  std::uint64_t reference_halo_begin = 0;  ///< where moved_indices expect the images

  std::uint64_t bytes() const { return list.memory_bytes() + moved_indices.memory_bytes(); }
};

class Neighbourhood {
 public:
  Neighbourhood(const Domain& domain, std::vector<std::unique_ptr<Body>>& bodies, bool poison);

  /// Index of the relation; requests for the same bodies and configuration share one.
  std::uint32_t request(std::uint32_t body, const shoal_relation_request& request);
  const std::vector<Relation>& relations() const { return relations_; }
  shoal_neighbours view(std::uint32_t relation) const;
  bool in_reference_relation(std::uint32_t body) const;
  const Body& body(std::uint32_t index) const { return *bodies_[index]; }

  void set_sort_interval(std::uint64_t renewals) { sort_interval_ = renewals; }
  std::uint64_t sort_interval() const { return sort_interval_; }

  /// Particles leave through periodic faces and come back at the opposite ones.
  void wrap_positions();
  /// Sorts bodies that are due; then images and lists of what has moved. Positions are finite and near the domain.
  void renew();
  /// Everything from the present positions, without sorting and counting: after a restart.
  void rebuild();
  /// Of a body that has particles joined or left. Its lists are those of before, until they are renewed.
  void particles_changed() { ++generation_; }
  /// Changes whenever a list or a halo may have moved.
  std::uint64_t generation() const { return generation_; }

  std::uint64_t bytes(std::uint32_t body) const;

  std::uint64_t renewals = 0;  ///< so far, over restarts
  std::uint64_t sorts = 0, list_builds = 0;
  std::uint64_t sort_ticks = 0, halo_ticks = 0, list_ticks = 0;

 private:
  double reach(std::uint32_t body, shoal_configuration configuration) const;
  void sort_due_bodies();
  void sort(Body& body);
  void build_halos(bool everything);
  void build_current_lists(bool everything);
  void build_reference_lists();
  void build(Relation& relation, const NeighbourGrid& sources, const double* targets);
  void move_reference_images();

  const Domain& domain_;
  std::vector<std::unique_ptr<Body>>& bodies_;
  bool poison_;
  std::vector<Relation> relations_;
  std::vector<NeighbourGrid> grids_;  ///< [body], of owned particles and images
  std::uint64_t sort_interval_ = 0;
  std::uint64_t generation_ = 1;
};

}  // namespace shoal::kernel
