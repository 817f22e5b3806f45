// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Running an operator in a unit test, on bodies made by hand, without the kernel: neighbours are found by looking at
// all pairs, and the same operator can run with packs (as in a run) or one neighbour after the other.
//
//     testing::Body water(2, {0, 0, 0.1, 0, ...});       // dimensions, positions
//     water.set("volume", 0.01);
//     testing::run(op, water, {&water}, {.smoothing_length = 0.13});
//     CHECK(water["acceleration"][0] == doctest::Approx(...));
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "shoal/operator.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::testing {

// Particles with fields of doubles, components interleaved. Fields that an operator names and the test does not set
// are zero.
class Body {
 public:
  Body(int dimensions, std::vector<double> positions)
      : dimensions_(dimensions), n_(positions.size() / static_cast<std::size_t>(dimensions)) {
    fields_["position"] = std::move(positions);
  }

  int dimensions() const { return dimensions_; }
  std::size_t size() const { return n_; }
  std::vector<double>& operator[](const std::string& field) { return fields_[field]; }
  void set(const std::string& field, double value) { fields_[field].assign(n_, value); }
  // One value per particle and component from a function of the particle's number.
  template <class Function>
  void set_each(const std::string& field, std::size_t components, Function&& value) {
    auto& data = fields_[field];
    data.clear();
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t c = 0; c < components; ++c) data.push_back(value(i, c));
  }
  double* data(const std::string& field, std::size_t components) {
    auto& values = fields_[field];
    // Packs are read whole, and vectors with a number of the next one: fields of a run are padded in the same way.
    values.reserve((n_ + SHOAL_PADDING) * components);
    values.resize(std::max(values.size(), n_ * components));
    return values.data();
  }

 private:
  int dimensions_;
  std::size_t n_;
  std::map<std::string, std::vector<double>> fields_;
};

struct Setup {
  double smoothing_length = 0;
  SmoothingKernel smoothing_kernel = SmoothingKernel::wendland_c2;
  double spacing = 0;
  double dt = 0;
  double time = 0;
  bool scalar = false;           // one neighbour after the other
  std::uint64_t generation = 1;  // of the lists: another number tells the operator that they are new
  double cutoff = 0;             // m, of the lists; 0: that of the smoothing kernel
  // Positions by which the lists of a body with itself are made, if not those that it has: particles that have moved since.
  std::vector<double> listed_at = {};
};

namespace impl {

struct Rows {
  std::vector<std::uint64_t> offsets;
  std::vector<std::uint32_t> counts, indices;
};

inline Rows all_pairs(Body& own, Body& other, double cutoff, const std::vector<double>& at = {}) {
  const auto d = static_cast<std::size_t>(own.dimensions());
  const auto &x = at.empty() ? own["position"] : at, &y = at.empty() ? other["position"] : at;
  Rows rows;
  for (std::size_t i = 0; i < own.size(); ++i) {
    rows.offsets.push_back(rows.indices.size());
    for (std::size_t j = 0; j < other.size(); ++j) {
      double squared = 0;
      for (std::size_t a = 0; a < d; ++a)
        squared += (x[i * d + a] - y[j * d + a]) * (x[i * d + a] - y[j * d + a]);
      if (squared < cutoff * cutoff && !(&own == &other && i == j))
        rows.indices.push_back(static_cast<std::uint32_t>(j));
    }
    rows.counts.push_back(static_cast<std::uint32_t>(rows.indices.size() - rows.offsets.back()));
    while (rows.indices.size() % SHOAL_PADDING != 0) rows.indices.push_back(rows.indices.back());
  }
  return rows;
}

inline std::uint32_t components_of(std::uint32_t rank, int dimensions, std::uint32_t array_components) {
  const auto d = static_cast<std::uint32_t>(dimensions);
  return rank == SHOAL_ARRAY         ? array_components
         : rank == SHOAL_SCALAR      ? 1
         : rank == SHOAL_RANK_VECTOR ? d
         : rank == SHOAL_SYMMETRIC   ? d * (d + 1) / 2
                                     : d * d;
}

template <class Op>
void run_chunk(const Op& op, int dimensions, const shoal_chunk& chunk, bool scalar) {
  if constexpr (requires { op.template run_chunk_scalar<2>(chunk); }) {
    if (scalar) {
      dimensions == 2 ? op.template run_chunk_scalar<2>(chunk) : op.template run_chunk_scalar<3>(chunk);
      return;
    }
  }
  dimensions == 2 ? op.template run_chunk<2>(chunk) : op.template run_chunk<3>(chunk);
}

template <class Op>
void prepare(const Op& op, int dimensions, const shoal_chunk& chunk) {
  if constexpr (requires { op.template prepare_chunk<2>(chunk); })
    if (op.prepares())
      dimensions == 2 ? op.template prepare_chunk<2>(chunk) : op.template prepare_chunk<3>(chunk);
}

}  // namespace impl

// Runs an operator once over all particles of `own`, in two chunks where there are enough.
template <class Op>
void run(Op& op, Body& own, std::vector<Body*> neighbours, const Setup& setup) {
  Target target;
  target.smoothing_kernel = setup.smoothing_kernel;
  target.smoothing_length = setup.smoothing_length;
  target.cutoff =
      setup.cutoff > 0 ? setup.cutoff : cutoff_radius(setup.smoothing_kernel, setup.smoothing_length);
  target.spacing = setup.spacing;
  target.neighbours.resize(neighbours.size());
  op.set_target(target);
  op.set_dimensions(own.dimensions());

  const auto accesses = op.accesses();
  std::vector<shoal_field> mine, theirs;
  const auto view = [](Body& body, const shoal_access& access) {
    const std::uint32_t components = impl::components_of(access.rank, body.dimensions(), access.components);
    return shoal_field{sizeof(shoal_field), components,  body.data(access.field, components),
                       body.size(),         body.size(), nullptr};
  };
  for (const shoal_access& access : accesses) mine.push_back(view(own, access));
  std::vector<impl::Rows> rows;
  std::vector<shoal_neighbours> lists;
  for (Body* body : neighbours) {
    for (const shoal_access& access : accesses) theirs.push_back(view(*body, access));
    rows.push_back(impl::all_pairs(own, *body, target.cutoff, setup.listed_at));
  }
  for (const impl::Rows& row : rows)
    lists.push_back({sizeof(shoal_neighbours), 0, row.offsets.data(), row.counts.data(), row.indices.data(),
                     own.size(), target.cutoff, setup.generation});
  op.bind({sizeof(shoal_binding), own.dimensions(), own.size(), mine.data(), lists.data(), theirs.data()});
  if constexpr (requires { op.bound(); }) op.bound();

  shoal_step step{};
  step.size = sizeof step;
  step.dimensions = own.dimensions();
  step.dt = step.parent_dt = setup.dt;
  step.time = step.parent_time = setup.time;
  op.set_step(step);
  if constexpr (requires { op.before_begin(); }) op.before_begin();
  if constexpr (requires { op.begin(); }) op.begin();

  std::vector<double> partials;
  for (const std::uint32_t how : op.reductions())
    partials.push_back(how == SHOAL_SUM       ? 0.0
                       : how == SHOAL_MINIMUM ? std::numeric_limits<double>::infinity()
                                              : -std::numeric_limits<double>::infinity());
  const std::uint64_t middle = own.size() / 2;
  const shoal_chunk first{sizeof(shoal_chunk), 0, 0, middle, partials.data()};
  const shoal_chunk second{sizeof(shoal_chunk), 1, middle, own.size(), partials.data()};
  for (const shoal_chunk& chunk : {first, second}) impl::prepare(op, own.dimensions(), chunk);
  for (const shoal_chunk& chunk : {first, second}) impl::run_chunk(op, own.dimensions(), chunk, setup.scalar);
  op.set_results(partials.data());
  if constexpr (requires { op.end(); }) op.end();
}

}  // namespace shoal::testing
