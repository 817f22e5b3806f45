// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Renewal of relations. What has not moved is not searched again.
#include "kernel/schedule/neighbourhood.hpp"

#include <algorithm>

#include "kernel/particles/parallel.hpp"
#include "kernel/schedule/stopwatch.hpp"

namespace shoal::kernel {

namespace {

constexpr std::uint64_t default_sort_interval = 50;

}  // namespace

Neighbourhood::Neighbourhood(const Domain& domain, std::vector<std::unique_ptr<Body>>& bodies, bool poison)
    : domain_(domain), bodies_(bodies), poison_(poison), sort_interval_(default_sort_interval) {}

std::uint32_t Neighbourhood::request(std::uint32_t body, const shoal_relation_request& request) {
  for (std::uint32_t k = 0; k < relations_.size(); ++k) {
    Relation& known = relations_[k];
    if (known.body != body || known.neighbours != request.body ||
        known.configuration != static_cast<shoal_configuration>(request.configuration))
      continue;
    known.cutoff = std::max(known.cutoff, request.cutoff);
    return k;
  }
  Relation& relation = relations_.emplace_back();
  relation.body = body;
  relation.neighbours = request.body;
  relation.configuration = static_cast<shoal_configuration>(request.configuration);
  relation.cutoff = request.cutoff;
  return static_cast<std::uint32_t>(relations_.size() - 1);
}

shoal_neighbours Neighbourhood::view(std::uint32_t relation) const {
  const Relation& of = relations_[relation];
  shoal_neighbours c;
  c.size = sizeof c;
  c.body = of.neighbours;
  c.offsets = of.list.offsets();
  c.counts = of.list.counts();
  c.indices = of.moved_indices.capacity() > 0 ? of.moved_indices.data() : of.list.indices();
  c.n_rows = of.list.n_rows();
  c.cutoff = of.cutoff;
  c.generation = of.builds;
  return c;
}

bool Neighbourhood::in_reference_relation(std::uint32_t body) const {
  return std::any_of(relations_.begin(), relations_.end(), [&](const Relation& relation) {
    return relation.configuration == SHOAL_REFERENCE &&
           (relation.body == body || relation.neighbours == body);
  });
}

double Neighbourhood::reach(std::uint32_t body, shoal_configuration configuration) const {
  double largest = 0.0;
  for (const Relation& relation : relations_)
    if (relation.neighbours == body && relation.configuration == configuration)
      largest = std::max(largest, relation.cutoff);
  return largest;
}

void Neighbourhood::wrap_positions() {
  for (const auto& body : bodies_) {
    // Pairs of a reference list look at differences of positions: such a body leaves the box as a whole.
    if (!body->position_changed || in_reference_relation(body->index())) continue;
    if (wrap(domain_, body->position().reals(), body->n_owned()))
      body->mark_written(body->position(), poison_);
  }
}

void Neighbourhood::sort(Body& body) {
  double cell = std::max(reach(body.index(), SHOAL_CURRENT), body.cutoff);
  if (!(cell > 0.0)) cell = body.spacing > 0.0 ? body.spacing : 1.0;
  NeighbourGrid& grid = grids_[body.index()];
  grid.build({body.position().reals(), body.n_owned(), body.dimensions()}, cell);
  body.permute(grid.order());
  ++sorts;
}

void Neighbourhood::sort_due_bodies() {
  if (renewals % sort_interval_ != 0) return;
  for (const auto& body : bodies_) {
    // Reference lists name particles by index, so their bodies are sorted once, before the lists are built.
    if (!body->sorted_as_it_moves || !body->position_changed) continue;
    if (renewals > 0 && in_reference_relation(body->index())) continue;
    sort(*body);
  }
}

void Neighbourhood::build_halos(bool everything) {
  if (!domain_.has_images()) return;
  for (const auto& body : bodies_) {
    if (!everything && !body->position_changed) continue;
    const double radius = reach(body->index(), SHOAL_CURRENT);
    if (!(radius > 0.0)) continue;
    body->build_halo(domain_, radius);
    if (poison_)
      for (const auto& field : body->fields()) field->poison(body->n_owned(), body->n_total());
    body->renew_halo(body->position());
  }
}

void Neighbourhood::build_current_lists(bool everything) {
  for (const auto& other : bodies_) {
    // The grid of a body that rests, a wall for instance, stands.
    bool has_grid = !everything && !other->position_changed && grids_[other->index()].n() > 0;
    for (Relation& relation : relations_) {
      if (relation.configuration != SHOAL_CURRENT || relation.neighbours != other->index()) continue;
      const Body& own = *bodies_[relation.body];
      if (!everything && relation.builds > 0 && !own.position_changed && !other->position_changed) continue;
      NeighbourGrid& grid = grids_[other->index()];
      if (!has_grid)
        grid.build({other->position().reals(), other->n_owned() + other->halo().size(), other->dimensions()},
                   reach(other->index(), SHOAL_CURRENT));
      has_grid = true;
      build(relation, grid, own.position().reals());
    }
  }
}

void Neighbourhood::build(Relation& relation, const NeighbourGrid& sources, const double* targets) {
  const Body& own = *bodies_[relation.body];
  relation.list.build(sources, {targets, own.n_owned(), own.dimensions()}, relation.cutoff,
                      relation.body == relation.neighbours);
  ++relation.builds;
  ++list_builds;
}

void Neighbourhood::build_reference_lists() {
  const bool due = std::any_of(relations_.begin(), relations_.end(), [](const Relation& relation) {
    return relation.configuration == SHOAL_REFERENCE && relation.builds == 0;
  });
  if (!due) return;
  // There are no images of the current configuration yet, so those of the reference stand right behind the owned.
  for (const auto& body : bodies_) {
    const double radius = reach(body->index(), SHOAL_REFERENCE);
    if (!(radius > 0.0) || !domain_.has_images()) continue;
    body->build_reference_halo(domain_, radius);
    body->renew_halo(*body->find("reference_position"));
  }
  NeighbourGrid grid;
  for (Relation& relation : relations_) {
    if (relation.configuration != SHOAL_REFERENCE) continue;
    const Body& own = *bodies_[relation.body];
    const Body& other = *bodies_[relation.neighbours];
    grid.build({other.find("reference_position")->reals(), other.n_owned() + other.reference_halo().size(),
                other.dimensions()},
               relation.cutoff);
    build(relation, grid, own.find("reference_position")->reals());
    relation.reference_halo_begin = other.n_owned();
  }
}

// Images of the current configuration come and go in front of those of the reference.
void Neighbourhood::move_reference_images() {
  for (Relation& relation : relations_) {
    if (relation.configuration != SHOAL_REFERENCE) continue;
    const Body& other = *bodies_[relation.neighbours];
    const std::uint64_t begin = other.reference_halo_begin();
    if (begin == relation.reference_halo_begin || other.reference_halo().size() == 0) continue;
    const std::uint64_t n_entries = relation.list.offsets()[relation.list.n_rows()];
    const auto n_owned = static_cast<std::uint32_t>(other.n_owned());
    const auto shift = static_cast<std::uint32_t>(begin - other.n_owned());
    relation.moved_indices.reserve(n_entries);
    const std::uint32_t* from = relation.list.indices();
    std::uint32_t* to = relation.moved_indices.data();
    for_each_range(n_entries, [=](std::uint64_t first, std::uint64_t last) {
      for (std::uint64_t k = first; k < last; ++k) to[k] = from[k] < n_owned ? from[k] : from[k] + shift;
    });
    relation.reference_halo_begin = begin;
  }
}

void Neighbourhood::renew() {
  const std::uint64_t begin = Stopwatch::now();
  grids_.resize(bodies_.size());
  sort_due_bodies();
  const std::uint64_t sorted = Stopwatch::now();
  build_reference_lists();
  build_halos(false);
  move_reference_images();
  const std::uint64_t with_halos = Stopwatch::now();
  build_current_lists(false);
  const std::uint64_t end = Stopwatch::now();
  sort_ticks += sorted - begin;
  halo_ticks += with_halos - sorted;
  list_ticks += end - with_halos;
  ++renewals;
  ++generation_;
  for (const auto& body : bodies_) body->position_changed = false;
}

void Neighbourhood::rebuild() {
  grids_.resize(bodies_.size());
  build_reference_lists();
  build_halos(true);
  move_reference_images();
  build_current_lists(true);
  ++generation_;
}

std::uint64_t Neighbourhood::bytes(std::uint32_t body) const {
  std::uint64_t sum = 0;
  for (const Relation& relation : relations_)
    if (relation.body == body) sum += relation.bytes();
  if (body < grids_.size()) sum += grids_[body].memory_bytes();
  return sum;
}

}  // namespace shoal::kernel
