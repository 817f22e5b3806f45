// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points are near a place, for the preparation of particles: a plain serial grid that depends on
// nothing else. The step loop has a faster one; this one serves before there are particles, fields and
// threads.
#pragma once

#include <cstdint>
#include <vector>

#include "shape.hpp"

namespace shoal::kernel {

/// A box of which some axes are periodic. The extents of the other axes are not looked at.
struct PeriodicBox {
  Point lower{};
  Point upper{};
  std::array<bool, 3> periodic{};

  /// The shortest of the images of a difference of two places.
  [[nodiscard]] Point shortest(Point difference) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (!periodic[a]) continue;
      const double length = upper[a] - lower[a];
      difference[a] -= length * std::nearbyint(difference[a] / length);
    }
    return difference;
  }
  /// The image of a place that lies in [lower, upper).
  [[nodiscard]] Point wrapped(Point p) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (!periodic[a]) continue;
      const double length = upper[a] - lower[a];
      p[a] -= length * std::floor((p[a] - lower[a]) / length);
      if (p[a] >= upper[a]) p[a] = lower[a];
    }
    return p;
  }
};

class CellGrid {
 public:
  /// Sorts the points into cells at least `reach` wide. Points must lie within the periodic extents. Cost and
  /// memory are linear in the number of points, however empty the box around them is.
  CellGrid(const std::vector<Point>& points, const PeriodicBox& box, double reach, int dimension);

  /// Calls visit(j) for every point in the cells within reach of p: a superset of the points within `reach`,
  /// each once, in a fixed order.
  template <class Visit>
  void near(const Point& p, Visit&& visit) const {
    std::array<std::array<std::int64_t, 3>, 3> cells{};
    std::array<int, 3> count{};
    for (std::size_t a = 0; a < 3; ++a) count[a] = neighbours(a, cell_of(a, p[a]), cells[a]);
    for (int k = 0; k < count[2]; ++k) {
      for (int j = 0; j < count[1]; ++j) {
        for (int i = 0; i < count[0]; ++i) {
          const std::size_t cell =
              index(cells[0][static_cast<std::size_t>(i)], cells[1][static_cast<std::size_t>(j)],
                    cells[2][static_cast<std::size_t>(k)]);
          for (std::uint32_t s = start_[cell]; s < start_[cell + 1]; ++s) visit(sorted_[s]);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::int64_t cell_of(std::size_t axis, double x) const;
  [[nodiscard]] int neighbours(std::size_t axis, std::int64_t cell, std::array<std::int64_t, 3>& out) const;
  [[nodiscard]] std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i);
  }

  std::array<bool, 3> periodic_;
  Point lower_{};
  Point width_{1.0, 1.0, 1.0};
  std::array<std::int64_t, 3> count_{1, 1, 1};
  std::vector<std::uint32_t> start_;
  std::vector<std::uint32_t> sorted_;
};

}  // namespace shoal::kernel
