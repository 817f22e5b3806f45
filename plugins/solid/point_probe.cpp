// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "point_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shoal::solid {
namespace {

constexpr const char* axis_names[] = {"displacement_x", "displacement_y", "displacement_z"};

// The particles no farther from the point than a fifth more than the nearest one.
std::vector<std::size_t> nearest_to(const Vector3& at, std::size_t d, std::uint64_t n, const double* X) {
  std::vector<double> square(n, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (std::uint64_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < d; ++a) square[i] += (X[d * i + a] - at[a]) * (X[d * i + a] - at[a]);
    least = std::min(least, square[i]);
  }
  std::vector<std::size_t> nearest;
  for (std::uint64_t i = 0; i < n; ++i)
    if (square[i] <= 1.44 * least) nearest.push_back(i);
  return nearest;
}

}  // namespace

std::vector<Probe::Column> PointProbe::columns() const {
  std::vector<Column> list;
  for (int a = 0; a < dimensions(); ++a) list.push_back({axis_names[a], "m"});
  return list;
}

std::vector<Probe::Need> PointProbe::needs() const {
  return {{body->name, "reference_position"}, {body->name, "current_deformation_gradient"}};
}

void PointProbe::sample(const shoal_snapshot& snapshot, double* values) {
  const shoal_snapshot_body& found = *find_body(snapshot, body->name);
  const auto d = static_cast<std::size_t>(dimensions());
  const auto* X = static_cast<const double*>(find_field(found, "reference_position")->data);
  const auto* F = static_cast<const double*>(find_field(found, "current_deformation_gradient")->data);
  if (nearest_.empty()) nearest_ = nearest_to(at, d, found.n_particles, X);
  std::fill_n(values, d, 0.0);
  for (const std::size_t i : nearest_)
    for (std::size_t a = 0; a < d; ++a) {
      values[a] += found.position[d * i + a] - at.value()[a];
      for (std::size_t b = 0; b < d; ++b)
        values[a] += F[d * d * i + d * a + b] * (at.value()[b] - X[d * i + b]);
    }
  for (std::size_t a = 0; a < d; ++a) values[a] /= static_cast<double>(nearest_.size());
}

}  // namespace shoal::solid
