// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators of C callbacks made by hand, so that the kernel is tested against its contract and not against the SDK.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "kernel/schedule/simulation.hpp"
#include "shoal/abi.h"

namespace hand_made {

struct Views {
  int dimensions = 0;
  std::uint64_t n_owned = 0;
  std::vector<shoal_field> own, of_neighbours;
  std::vector<shoal_neighbours> neighbours;

  double* real(std::size_t access) const { return static_cast<double*>(own[access].data); }
  std::int64_t* integer(std::size_t access) const { return static_cast<std::int64_t*>(own[access].data); }
  const double* neighbour_real(std::size_t relation, std::size_t access) const {
    return static_cast<const double*>(of_neighbours[relation * own.size() + access].data);
  }
};

struct Operator {
  std::string name = "test.operator";
  std::uint32_t body = 0;
  std::uint32_t flags = 0;
  std::vector<shoal_access> accesses;
  std::vector<shoal_relation_request> relations;
  std::vector<std::uint32_t> reductions;

  std::uint32_t bytes_per_pair = 0, bytes_per_particle = 0;

  std::function<shoal_status(const Views&)> bind;
  std::function<shoal_status(const shoal_step&)> begin;
  std::function<shoal_status(const Views&, const shoal_step&, const shoal_chunk&)> prepare, run;
  std::function<shoal_status(const shoal_step&, const double*)> end;
  std::function<double(const Views&, const shoal_step&, const shoal_chunk&)> time_step;
  std::function<shoal_status(const shoal_stream&)> save, load;
  std::function<void()> destroy;
  std::function<shoal_status(const Views&, const shoal_step&, shoal_exchange&)> exchange;
  std::function<shoal_status(const Views&, const shoal_step&, std::uint64_t, std::uint64_t)> fill;

  Operator& access(const char* field, std::uint32_t mode, shoal_rank rank = SHOAL_SCALAR,
                   shoal_data_type type = SHOAL_DOUBLE) {
    accesses.push_back({sizeof(shoal_access), mode, rank, type, field, nullptr, nullptr, 0, 0});
    return *this;
  }
  Operator& relation(std::uint32_t neighbours, double cutoff,
                     shoal_configuration configuration = SHOAL_CURRENT) {
    relations.push_back(
        {sizeof(shoal_relation_request), neighbours, static_cast<std::uint32_t>(configuration), 0, cutoff});
    return *this;
  }
};

struct Attached {
  Operator op;
  Views views;
};

inline Attached& of(void* self) { return *static_cast<Attached*>(self); }

inline shoal_operator to_c(Operator op) {
  auto* attached = new Attached{std::move(op), {}};
  const Operator& kept = attached->op;
  shoal_operator c{};
  c.size = sizeof c;
  c.flags = kept.flags;
  c.name = kept.name.c_str();
  c.body = kept.body;
  c.n_accesses = static_cast<std::uint32_t>(kept.accesses.size());
  c.accesses = kept.accesses.data();
  c.n_relations = static_cast<std::uint32_t>(kept.relations.size());
  c.relations = kept.relations.data();
  c.n_reductions = static_cast<std::uint32_t>(kept.reductions.size());
  c.reductions = kept.reductions.data();
  c.self = attached;
  c.destroy = [](void* self) {
    if (of(self).op.destroy) of(self).op.destroy();
    delete &of(self);
  };
  c.bind = [](void* self, const shoal_binding* binding) {
    Attached& a = of(self);
    const std::size_t n = a.op.accesses.size(), r = a.op.relations.size();
    a.views.dimensions = binding->dimensions;
    a.views.n_owned = binding->n_owned;
    a.views.own.assign(binding->own, binding->own + n);
    a.views.neighbours.assign(binding->neighbours, binding->neighbours + r);
    a.views.of_neighbours.assign(binding->of_neighbours, binding->of_neighbours + r * n);
    return a.op.bind ? a.op.bind(a.views) : SHOAL_OK;
  };
  c.begin = [](void* self, const shoal_step* step) {
    return of(self).op.begin ? of(self).op.begin(*step) : SHOAL_OK;
  };
  c.run = [](void* self, const shoal_step* step, const shoal_chunk* chunk) {
    return of(self).op.run ? of(self).op.run(of(self).views, *step, *chunk) : SHOAL_OK;
  };
  c.end = [](void* self, const shoal_step* step, const double* results) {
    return of(self).op.end ? of(self).op.end(*step, results) : SHOAL_OK;
  };
  if (kept.time_step)
    c.time_step = [](void* self, const shoal_step* step, const shoal_chunk* chunk) {
      return of(self).op.time_step(of(self).views, *step, *chunk);
    };
  if (kept.save) {
    c.save = [](void* self, const shoal_stream* stream) { return of(self).op.save(*stream); };
    c.load = [](void* self, const shoal_stream* stream) { return of(self).op.load(*stream); };
  }
  if (kept.prepare)
    c.prepare = [](void* self, const shoal_step* step, const shoal_chunk* chunk) {
      return of(self).op.prepare(of(self).views, *step, *chunk);
    };
  c.bytes_per_pair = kept.bytes_per_pair;
  c.bytes_per_particle = kept.bytes_per_particle;
  if (kept.exchange)
    c.exchange = [](void* self, const shoal_step* step, shoal_exchange* asked) {
      return of(self).op.exchange(of(self).views, *step, *asked);
    };
  if (kept.fill)
    c.fill = [](void* self, const shoal_step* step, std::uint64_t begin, std::uint64_t end) {
      return of(self).op.fill(of(self).views, *step, begin, end);
    };
  return c;
}

/// The builder as physics see it; a call that fails throws its text.
class Physics {
 public:
  explicit Physics(shoal::kernel::Simulation& simulation)
      : simulation_(simulation), c_(*simulation.builder()) {}

  void loop(const char* name, std::vector<const char*> stages, const char* parent = nullptr,
            const char* parent_stage = nullptr) const {
    check(c_.loop(c_.context, name, parent, parent_stage, static_cast<std::uint32_t>(stages.size()),
                  stages.data()));
  }
  void renew_neighbours_in(const char* loop) const { check(c_.renew_neighbours_in(c_.context, loop)); }
  void attach(const char* loop, const char* stage, Operator op) const {
    const shoal_operator c = to_c(std::move(op));
    check(c_.attach(c_.context, loop, stage, &c));
  }
  void own_field(std::uint32_t body, const char* field, const char* loop, const char* stage) const {
    check(c_.own_field(c_.context, body, field, loop, stage));
  }
  void guard(std::uint32_t body, const char* field, double minimum, double maximum) const {
    check(c_.guard(c_.context, body, field, minimum, maximum));
  }
  void body_moves(std::uint32_t body) const { check(c_.body_moves(c_.context, body, 1)); }
  const shoal_builder& c() const { return c_; }

 private:
  void check(shoal_status status) const {
    if (status != SHOAL_OK) throw shoal::kernel::ModelError(simulation_.builder_failure());
  }
  shoal::kernel::Simulation& simulation_;
  const shoal_builder& c_;
};

/// A lattice of particles in [0, n dx) along each axis, at the centres of cells.
inline shoal::kernel::BodySpecification lattice(const char* name, int dimensions, std::vector<int> n,
                                                double dx, std::vector<double> lower = {0.0, 0.0, 0.0}) {
  shoal::kernel::BodySpecification body;
  body.name = name;
  body.spacing = dx;
  body.smoothing_length = 1.3 * dx;
  body.cutoff = 2.6 * dx;
  body.smoothing_kernel = "wendland_c2";
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < (dimensions == 3 ? n[2] : 1); ++k) {
        const int cell[3] = {i, j, k};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimensions); ++a)
          body.positions.push_back(lower[a] + (cell[a] + 0.5) * dx);
      }
  return body;
}

inline shoal::kernel::SimulationSettings settings(int dimensions, double end_time) {
  shoal::kernel::SimulationSettings what;
  what.dimensions = dimensions;
  what.end_time = end_time;
  what.threads = 1;
  what.poison = true;
  return what;
}

/// A step limit that never changes.
inline Operator limiter(double dt, const char* name = "test.limit") {
  Operator op;
  op.name = name;
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.time_step = [dt](const Views&, const shoal_step&, const shoal_chunk&) { return dt; };
  return op;
}

/// Moves particles: x += v dt.
inline Operator mover(std::uint32_t body = 0) {
  Operator op;
  op.name = "test.move";
  op.body = body;
  op.access("position", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_VECTOR)
      .access("velocity", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
    const auto d = static_cast<std::uint64_t>(step.dimensions);
    for (std::uint64_t k = chunk.begin * d; k < chunk.end * d; ++k)
      views.real(0)[k] += step.dt * views.real(1)[k];
    return SHOAL_OK;
  };
  return op;
}

inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace hand_made
