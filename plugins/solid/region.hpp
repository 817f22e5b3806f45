// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Part of a body, chosen by a condition on reference positions, or by a shape, or by both.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "shoal/parameters.hpp"

namespace shoal::solid {

// Loads and motions that a case gives as expressions of t must stay numbers.
inline double finite(double value, double time) {
  if (std::isfinite(value)) return value;
  char text[160];
  std::snprintf(text, sizeof text,
                "a value that the case gives is not a finite number at t = %.6g s; check for a division by "
                "zero or a root of a negative number",
                time);
  throw CaseError(text);
}

class Region {
 public:
  Expression where;             // without it: everything
  std::shared_ptr<void> shape;  // made by `api`
  std::string place;            // in the case, for messages
  const shoal_shape_api* api = nullptr;
  double margin = 0.0;  // m, around the shape

  // Finds out whether each particle belongs to it.
  void look(int dimensions, std::uint64_t n, const double* reference_position) {
    inside_.assign(n, 1);
    std::vector<double> value(n);
    if (where) {
      where.evaluate(dimensions, n, reference_position, 0.0, value.data());
      for (std::uint64_t i = 0; i < n; ++i) inside_[i] = value[i] != 0.0;
    }
    if (!shape) return;
    std::vector<double> points(3 * n, 0.0);
    const auto d = static_cast<std::size_t>(dimensions);
    for (std::uint64_t i = 0; i < n; ++i)
      for (std::size_t a = 0; a < d; ++a) points[3 * i + a] = reference_position[d * i + a];
    check_host(api->distance(shape.get(), n, points.data(), value.data()));
    for (std::uint64_t i = 0; i < n; ++i)
      if (value[i] > margin) inside_[i] = 0;
  }
  bool looked() const { return !inside_.empty(); }
  bool holds(std::uint64_t i) const { return inside_[i] != 0; }

 private:
  std::vector<std::uint8_t> inside_;
};

// The particles of a region, and values of expressions at their reference positions.
class RegionValues {
 public:
  Region region;

  void look(int dimensions, std::uint64_t n, const double* reference_position) {
    region.look(dimensions, n, reference_position);
    const auto d = static_cast<std::uint64_t>(dimensions);
    for (std::uint64_t i = 0; i < n; ++i) {
      if (!region.holds(i)) continue;
      particles_.push_back(i);
      positions_.insert(positions_.end(), reference_position + d * i, reference_position + d * (i + 1));
    }
    if (particles_.empty())
      throw CaseError(
          region.place +
          ": no particle of the body lies in the region, which is of positions before deformation");
    values_.resize(particles_.size());
  }
  bool looked() const { return region.looked(); }
  const std::vector<std::uint64_t>& particles() const { return particles_; }
  // Those with numbers begin ... end - 1.
  std::span<const std::uint64_t> particles(std::uint64_t begin, std::uint64_t end) const {
    const auto from = std::lower_bound(particles_.begin(), particles_.end(), begin);
    return {from, std::lower_bound(from, particles_.end(), end)};
  }
  bool holds(std::uint64_t i) const { return region.holds(i); }
  // Written to `out` at the particles' own numbers.
  void evaluate(const Expression& expression, int dimensions, double time, std::vector<double>& out) const {
    expression.evaluate(dimensions, particles_.size(), positions_.data(), time, values_.data());
    for (std::size_t k = 0; k < particles_.size(); ++k) out[particles_[k]] = finite(values_[k], time);
  }

 private:
  std::vector<std::uint64_t> particles_;
  std::vector<double> positions_;
  mutable std::vector<double> values_;
};

inline Region region_of(const Param<Expression>& where, const Param<ObjectHandle>& within, int dimensions) {
  Region region;
  region.place = where.is_set() ? where.place() : within.place();
  if (where.is_set()) region.where = where.value();
  if (within.is_set()) {
    const shoal_object* object = within->object;
    region.api = static_cast<const shoal_shape_api*>(object->type->api);
    void* self = nullptr;
    check_host(region.api->create(object, dimensions, &self));
    region.shape = std::shared_ptr<void>(self, region.api->destroy);
  }
  return region;
}

}  // namespace shoal::solid
