// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// From a coordinate to a cell number along one axis of a NeighbourGrid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace shoal::kernel {

/// A monotone map from a coordinate to a fractional cell number. The axis is cut into slices at least one cut-off
/// wide, and each slice into `divisions` cells. Either all slices between the lowest and the highest particle have
/// cells, or, when particles stand far apart, runs of empty slices are shortened to two, so that the number of cells
/// is bounded by the number of particles however far one of them has flown. Places closer than the cut-off to each
/// other, of which at least one holds a particle, keep their distance under the map.
class AxisMap {
 public:
  /// All slices from `lower` to `upper`.
  void set_uniform(double lower, double upper, double width, int divisions);
  /// Only the slices around the given coordinates, which stand `stride` numbers apart. Sorts: O(n log n).
  void set_compressed(const double* coordinates, std::size_t n, std::size_t stride, double width,
                      int divisions);

  /// Number of cells.
  std::int64_t cells() const { return cells_; }
  /// Width of a cell, in m.
  double cell_width() const { return 1.0 / per_cell_; }
  /// Cells per metre.
  double per_cell() const { return per_cell_; }

  /// Fractional cell number of any coordinate, within +-far, so that it fits an integer. What is not a number is far.
  double locate(double x) const { return limited(unlimited(x)); }
  /// The same of n coordinates that stand `stride` numbers apart.
  void locate(const double* x, std::size_t n, std::size_t stride, double* u) const {
    if (!is_uniform()) {
      for (std::size_t i = 0; i < n; ++i) u[i] = limited(locate_in_segments(x[i * stride]));
      return;
    }
    const double lower = lower_, per_cell = per_cell_;
    for (std::size_t i = 0; i < n; ++i) u[i] = limited((x[i * stride] - lower) * per_cell);
  }
  /// Cell of a coordinate that holds a particle.
  std::int64_t cell(double x) const {
    const auto c = static_cast<std::int64_t>(std::floor(unlimited(x)));
    return std::clamp<std::int64_t>(c, 0, cells_ - 1);
  }
  bool is_uniform() const { return segments_.empty(); }

  static constexpr double far = 0x1p50;

 private:
  static double limited(double u) { return std::min(far, std::max(-far, u)); }

  // Occupied slices first ... first + length - 1 (in slices from coordinate zero) become offset ... + length - 1.
  struct Segment {
    double first;
    double length;
    double offset;
  };
  double unlimited(double x) const { return is_uniform() ? (x - lower_) * per_cell_ : locate_in_segments(x); }
  double locate_in_segments(double x) const;

  double lower_ = 0.0;
  double per_cell_ = 1.0;
  double per_width_ = 1.0;
  int divisions_ = 1;
  std::int64_t cells_ = 1;
  std::vector<Segment> segments_;
};

}  // namespace shoal::kernel
