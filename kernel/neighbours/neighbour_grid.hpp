// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Particles sorted into cells: where neighbour search looks, and the order in which a body is kept in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernel/neighbours/aligned_buffer.hpp"
#include "kernel/neighbours/axis_map.hpp"

namespace shoal::kernel {

/// n points in 2 or 3 dimensions, components interleaved. The memory is the caller's.
struct Positions {
  const double* data = nullptr;
  std::size_t n = 0;
  int dimensions = 3;
};

/// Cells numbered linearly, the axis of the longest extent slowest and that of the shortest fastest; along the
/// fastest axis ("rows") neighbouring cells, and therefore their particles, follow one another in memory. Within a
/// cell particles keep the order in which they came, so the result is the same for any number of threads.
///
/// Rows are one cut-off wide; along a row cells are finer (see `fast_divisions`). The number of cells is O(n) however
/// far particles stand apart. Positions that are not finite, or so far away that a cut-off is lost in rounding, are
/// counted, take part in nothing, and come last in `order()`.
class NeighbourGrid {
 public:
  /// Fills the grid for searches up to `cutoff`. Uses TBB's threads if n is large.
  void build(Positions positions, double cutoff);

  std::size_t n() const { return n_; }
  std::size_t n_invalid() const { return n_invalid_; }
  std::size_t n_valid() const { return n_ - n_invalid_; }
  /// Index of the first position that is not a number or too far away; n() if there is none.
  std::size_t first_invalid() const { return first_invalid_; }
  int dimensions() const { return dimensions_; }
  double cutoff() const { return cutoff_; }

  /// order()[k] is the particle that stands at place k when sorted by cells. n() entries.
  const std::uint32_t* order() const { return order_.data(); }
  std::uint64_t n_cells() const { return n_cells_; }
  /// Particles of cell c are at places cell_start()[c] ... cell_start()[c + 1] - 1.
  const std::uint32_t* cell_start() const { return cell_start_.data(); }
  /// Coordinate along `axis` (0 = x) of the sorted particles; n_valid() numbers, and some readable ones behind them.
  const double* sorted(int axis) const { return sorted_[axis].data(); }
  /// The axes from fastest to slowest; in 2D the third does not exist.
  int axis(int rank) const { return axis_[rank]; }
  const AxisMap& map(int rank) const { return map_[rank]; }
  /// What rounding may cost the position of a particle among the cells, in m.
  double rounding() const { return rounding_; }

  std::size_t memory_bytes() const;

  /// Cells per cut-off along a row, at most. More give shorter runs and more cells.
  static constexpr int fast_divisions = 8;
  /// Readable numbers behind the sorted coordinates, for loads of whole vectors.
  static constexpr std::size_t slack = 16;

 private:
  template <int D>
  void build_in(Positions positions);
  template <int D>
  void find_bounds(Positions positions);
  void choose_axes();
  void choose_cells(Positions positions);
  bool fits() const;
  void compress_axes(Positions positions, double width, int divisions);
  template <int D>
  std::uint32_t cell_of(const double* x) const;
  template <int D>
  void sort_serial(Positions positions);
  template <int D>
  void sort_parallel(Positions positions);
  template <int D>
  void place(const double* x, std::uint32_t particle, std::uint32_t place);
  bool is_valid(double x) const { return x >= -limit_ && x <= limit_; }

  std::size_t n_ = 0, n_invalid_ = 0, first_invalid_ = 0;
  int dimensions_ = 3;
  double cutoff_ = 0.0, limit_ = 0.0, rounding_ = 0.0;
  double lower_[3] = {}, upper_[3] = {};
  int axis_[3] = {0, 1, 2};
  AxisMap map_[3];
  std::uint64_t n_cells_ = 0;

  AlignedBuffer<std::uint32_t> order_, cell_start_, cell_, scratch_, counts_;
  AlignedBuffer<double> sorted_[3], valid_;
};

}  // namespace shoal::kernel
