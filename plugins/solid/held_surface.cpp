// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "held_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace shoal::solid {
namespace {

// Signed distances of points (three numbers each) to the nearest of the shapes.
std::vector<double> distances(const std::vector<Region>& regions, const std::vector<double>& points) {
  std::vector<double> least(points.size() / 3, HUGE_VAL), one(points.size() / 3);
  for (const Region& region : regions) {
    check_host(region.api->distance(region.shape.get(), one.size(), points.data(), one.data()));
    for (std::size_t i = 0; i < one.size(); ++i) least[i] = std::min(least[i], one[i]);
  }
  return least;
}

// Particles by cells of one spacing.
class Cells {
 public:
  Cells(int dimensions, const double* position, double spacing)
      : d_(static_cast<std::size_t>(dimensions)), x_(position), spacing_(spacing) {}

  void add(std::uint64_t i) { cells_[key(cell(i))].push_back(i); }
  // The nearest within two spacings, the first of those equally near but for rounding; `none` if there is none.
  std::uint64_t nearest(std::uint64_t to, std::uint64_t none) const {
    const std::array<std::int64_t, 3> centre = cell(to);
    std::uint64_t found = none;
    double least = 4.0 * spacing_ * spacing_;
    const std::int64_t depth = d_ == 3 ? 2 : 0;
    for (std::int64_t a = -2; a <= 2; ++a)
      for (std::int64_t b = -2; b <= 2; ++b)
        for (std::int64_t c = -depth; c <= depth; ++c) {
          const auto at = cells_.find(key({centre[0] + a, centre[1] + b, centre[2] + c}));
          if (at == cells_.end()) continue;
          for (const std::uint64_t i : at->second) {
            double square = 0;
            for (std::size_t k = 0; k < d_; ++k)
              square += (x_[d_ * i + k] - x_[d_ * to + k]) * (x_[d_ * i + k] - x_[d_ * to + k]);
            const bool nearer = square < (1.0 - 1e-9) * least;
            if (nearer || (square <= (1.0 + 1e-9) * least && i < found))
              least = std::min(least, square), found = i;
          }
        }
    return found;
  }

 private:
  std::array<std::int64_t, 3> cell(std::uint64_t i) const {
    std::array<std::int64_t, 3> at{};
    for (std::size_t k = 0; k < d_; ++k)
      at[k] = static_cast<std::int64_t>(std::floor(x_[d_ * i + k] / spacing_));
    return at;
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& at) {
    std::uint64_t hash = 0;
    for (const std::int64_t one : at) hash = (hash << 21) ^ (static_cast<std::uint64_t>(one) & 0x1fffff);
    return hash;
  }

  std::size_t d_;
  const double* x_;
  double spacing_;
  std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> cells_;
};

}  // namespace

HeldRegions held_regions(const Builder& b, BodyIndex body) {
  static std::map<std::pair<const void*, std::uint32_t>, std::weak_ptr<std::vector<Region>>> known;
  const auto law = b.material_interface<shoal_stress_law>(body, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
  std::weak_ptr<std::vector<Region>>& entry = known[{law.self, body.value}];
  HeldRegions regions = entry.lock();
  if (!regions) entry = regions = std::make_shared<std::vector<Region>>();
  return regions;
}

void HeldSurface::look(const std::vector<Region>& regions, int dimensions, std::uint64_t n, const double* x,
                       double dx) {
  if (regions.empty()) return;
  spacing = dx;
  const auto d = static_cast<std::size_t>(dimensions);
  std::vector<double> points(3 * n, 0.0);
  for (std::uint64_t i = 0; i < n; ++i)
    for (std::size_t a = 0; a < d; ++a) points[3 * i + a] = x[d * i + a];
  distance = distances(regions, points);
  shift.assign(n * d, 0.0);
  const double step = 1e-4 * spacing;
  for (std::size_t a = 0; a < d; ++a) {
    for (std::uint64_t i = 0; i < n; ++i) points[3 * i + a] += step;
    const std::vector<double> ahead = distances(regions, points);
    for (std::uint64_t i = 0; i < n; ++i) points[3 * i + a] -= 2.0 * step;
    const std::vector<double> behind = distances(regions, points);
    for (std::uint64_t i = 0; i < n; ++i) {
      points[3 * i + a] += step;
      shift[d * i + a] = distance[i] * (ahead[i] - behind[i]) / (2.0 * step);
    }
  }
}

void cut_volumes(const HeldSurface& surface, int dimensions, const double* x, double* volume) {
  const std::vector<double>& distance = surface.distance;
  const double spacing = surface.spacing;
  Cells in_front(dimensions, x, spacing);
  const std::uint64_t n = distance.size();
  for (std::uint64_t i = 0; i < n; ++i)
    if (!surface.holds(i) && distance[i] < 2.0 * spacing) in_front.add(i);
  std::vector<double> more(n, 0.0);
  std::vector<std::uint8_t> beside(n, 0);  // whether the body goes on behind the surface there
  for (std::uint64_t i = 0; i < n; ++i) {
    if (!surface.shows(i)) continue;
    const std::uint64_t nearest = in_front.nearest(i, n);
    if (nearest == n) continue;
    beside[nearest] = 1;
    more[nearest] += std::max(0.0, 0.5 + distance[i] / spacing) * volume[i];
  }
  for (std::uint64_t i = 0; i < n; ++i)
    if (beside[i] != 0) volume[i] = volume[i] * std::min(1.0, 0.5 + distance[i] / spacing) + more[i];
}

void correct_ends(std::uint64_t n, const double* distance, double spacing, double* volume) {
  for (std::uint64_t i = 0; i < n; ++i) {
    const double depth = -distance[i] / spacing;
    if (depth < 2.0) volume[i] *= depth < 1.0 ? 25.0 / 24.0 : 23.0 / 24.0;
  }
}

}  // namespace shoal::solid
