// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Counting sort of points into cells.
#include "cell_grid.hpp"

namespace shoal::kernel {

CellGrid::CellGrid(const std::vector<Point>& points, const PeriodicBox& box, double reach, int dimension)
    : periodic_(box.periodic) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    double lower = box.lower[a];
    double upper = box.upper[a];
    if (!periodic_[a]) {
      lower = infinity;
      upper = -infinity;
      for (const Point& p : points) {
        lower = std::min(lower, p[a]);
        upper = std::max(upper, p[a]);
      }
    }
    lower_[a] = points.empty() ? 0.0 : lower;
    const double cells = std::clamp(std::floor((upper - lower) / reach), 1.0, 1e6);
    count_[a] = static_cast<std::int64_t>(cells);
    width_[a] = std::max((upper - lower) / cells, reach);
    if (periodic_[a]) width_[a] = (upper - lower) / cells;
  }
  // A sparse cloud in a large box must not cost more cells than it has points.
  while (count_[0] * count_[1] * count_[2] > static_cast<std::int64_t>(points.size()) + 64) {
    const std::size_t a =
        static_cast<std::size_t>(std::max_element(count_.begin(), count_.end()) - count_.begin());
    const std::int64_t fewer = (count_[a] + 1) / 2;
    width_[a] *= static_cast<double>(count_[a]) / static_cast<double>(fewer);
    count_[a] = fewer;
  }
  start_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
  std::vector<std::uint32_t> cell(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    cell[i] = static_cast<std::uint32_t>(index(cell_of(0, p[0]), cell_of(1, p[1]), cell_of(2, p[2])));
    ++start_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  sorted_.resize(points.size());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) sorted_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
}

std::int64_t CellGrid::cell_of(std::size_t axis, double x) const {
  const double cell = std::floor((x - lower_[axis]) / width_[axis]);
  return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(count_[axis] - 1)));
}

int CellGrid::neighbours(std::size_t axis, std::int64_t cell, std::array<std::int64_t, 3>& out) const {
  const std::int64_t n = count_[axis];
  int found = 0;
  for (std::int64_t offset = -1; offset <= 1; ++offset) {
    std::int64_t c = cell + offset;
    if (periodic_[axis]) {
      if (n < 3 && offset > n - 2) continue;  // one or two cells: do not visit one twice
      c = (c + n) % n;
    } else if (c < 0 || c >= n) {
      continue;
    }
    out[static_cast<std::size_t>(found++)] = c;
  }
  return found;
}

}  // namespace shoal::kernel
