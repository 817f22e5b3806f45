// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Which runs of sorted particles may hold neighbours of a place: at most three cells of each slow axis, and along the
// fast axis the chord that a ball of the cut-off cuts out of each. Included by neighbour_list.cpp only.
//
// One place after another would wait for a root, roundings and look-ups that depend on each other; so a block of
// places goes through each of them together, in plain loops over short arrays that compilers turn into vectors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernel/neighbours/neighbour_grid.hpp"

namespace shoal::kernel {

/// The runs of some places, in ascending order of what they hold: run k of place i is begin[k][i] ... end[k][i] - 1,
/// and many are empty.
template <int D>
struct RunBlock {
  static constexpr std::size_t rows = 64, runs = D == 2 ? 3 : 9;
  alignas(64) std::uint32_t begin[runs][rows];
  alignas(64) std::uint32_t end[runs][rows];
  /// The lengths of all runs of a place together.
  alignas(64) std::uint32_t candidates[rows];
};

template <int D>
class RunFinder {
 public:
  RunFinder(const NeighbourGrid& grid, double cutoff)
      : grid_(grid),
        fast_cells_(static_cast<std::int32_t>(grid.map(0).cells())),
        slow_cells_(static_cast<std::int32_t>(grid.map(1).cells())),
        reach_(cutoff + grid.rounding()) {
    const double per_cell = grid.map(0).per_cell();
    chord_ = static_cast<float>(reach_ * per_cell * (1.0 + 1e-6));
    chord_margin_ = static_cast<float>(1e-4 + grid.rounding() * per_cell);
  }

  /// Finds the runs of `n` places, at most RunBlock::rows. Places behind them get empty runs, as do those that are not
  /// finite, or only particles that are out of their reach.
  void find(const double* x, std::size_t n, RunBlock<D>& block) const {
    FastCells fast;
    SlowCells rows, slabs;
    locate(x, n, fast);
    locate(1, x, n, rows);
    if constexpr (D == 3) locate(2, x, n, slabs);
    std::fill_n(block.candidates, places, 0u);
    for (int k = 0; k < (D == 3 ? 3 : 1); ++k)
      for (int j = 0; j < 3; ++j) {
        alignas(64) float gap[places];
        alignas(64) std::int32_t row[places];
        for (std::size_t i = 0; i < places; ++i) {
          gap[i] = rows.squared_gap[j][i];
          row[i] = rows.cell[j][i];
          if constexpr (D == 3) {
            gap[i] += slabs.squared_gap[k][i];
            row[i] += slabs.cell[k][i] * slow_cells_;
          }
        }
        cut(fast, gap, row, 3 * k + j, block);
      }
  }

 private:
  static constexpr std::size_t places = RunBlock<D>::rows;

  // Where places stand on the fast axis: their cells and the fractions of a cell beyond.
  struct FastCells {
    alignas(64) std::int32_t cell[places];
    alignas(64) float fraction[places];
  };
  // The three cells of a slow axis around each place, with the squares of the distances to them over the reach. A slow
  // cell is no narrower than the cut-off, so there is nothing to find in others. Cells outside of the grid are
  // replaced by cell 0 at a large distance.
  struct SlowCells {
    alignas(64) std::int32_t cell[3][places];
    alignas(64) float squared_gap[3][places];
  };
  static constexpr float out_of_reach = 4.0f;

  void locate(int rank, const double* x, std::size_t n, double* u) const {
    grid_.map(rank).locate(x + grid_.axis(rank), n, D, u);
    std::fill(u + n, u + places, -AxisMap::far);
  }

  void locate(const double* x, std::size_t n, FastCells& fast) const {
    alignas(64) double u[places];
    locate(0, x, n, u);
    // A place far outside of the grid has no cell that fits 32 bits, and no neighbours.
    const double limit = static_cast<double>(fast_cells_) + 2.0 * static_cast<double>(chord_);
    for (std::size_t i = 0; i < places; ++i) {
      const double whole = std::floor(u[i]);
      fast.cell[i] = static_cast<std::int32_t>(std::min(std::max(whole, -limit), limit));
      fast.fraction[i] = static_cast<float>(u[i] - whole);
    }
  }

  void locate(int rank, const double* x, std::size_t n, SlowCells& slow) const {
    alignas(64) double u[places];
    alignas(64) std::int32_t middle[places];
    locate(rank, x, n, u);
    const double rounding = grid_.rounding(), width = grid_.map(rank).cell_width(), per_reach = 1.0 / reach_;
    const auto cells = static_cast<std::int32_t>(grid_.map(rank).cells());
    const double last =
        static_cast<double>(cells) + 1.0;  // all three cells are outside here as anywhere above
    for (std::size_t i = 0; i < places; ++i) {
      const double whole = std::floor(u[i]);
      const double below = std::max(0.0, (u[i] - whole) * width - rounding) * per_reach;
      const double above = std::max(0.0, (1.0 - (u[i] - whole)) * width - rounding) * per_reach;
      middle[i] = static_cast<std::int32_t>(std::min(std::max(whole, -2.0), last));
      slow.squared_gap[0][i] = static_cast<float>(below * below);
      slow.squared_gap[1][i] = 0.0f;
      slow.squared_gap[2][i] = static_cast<float>(above * above);
    }
    for (int j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < places; ++i) {
        const std::int32_t cell = middle[i] + j - 1;
        const bool inside = (cell >= 0) & (cell < cells);
        slow.cell[j][i] = inside ? cell : 0;
        slow.squared_gap[j][i] = inside ? slow.squared_gap[j][i] : out_of_reach;
      }
  }

  // Cuts run `k` of each place out of a row of cells, whose distance is the root of `gap`.
  //
  // Chords are computed in single precision, relative to the cell of the place. Margins of 1e-5 in the squares and 1e-4
  // cells cover its rounding, so that no neighbour is missed.
  void cut(const FastCells& fast, const float* gap, const std::int32_t* row, int k,
           RunBlock<D>& block) const {
    alignas(64) std::int32_t begin[places], end[places];
    for (std::size_t i = 0; i < places; ++i) {
      const float rest = 1.0f + 1e-5f - gap[i];
      const float half = std::sqrt(std::max(0.0f, rest)) * chord_ + chord_margin_;
      const auto first = static_cast<std::int32_t>(std::floor(fast.fraction[i] - half));
      const auto last = static_cast<std::int32_t>(std::floor(fast.fraction[i] + half));
      const std::int32_t from = std::min(std::max(fast.cell[i] + first, 0), fast_cells_);
      const std::int32_t to = std::min(std::max(fast.cell[i] + last + 1, 0), fast_cells_);
      // Where nothing is left of the reach the run ends where it begins.
      begin[i] = row[i] * fast_cells_ + from;
      end[i] = row[i] * fast_cells_ + (rest > 0.0f ? to : from);
    }
    const std::uint32_t* const cell_start = grid_.cell_start();
    for (std::size_t i = 0; i < places; ++i) {
      block.begin[k][i] = cell_start[begin[i]];
      block.end[k][i] = cell_start[end[i]];
      block.candidates[i] += block.end[k][i] - block.begin[k][i];
    }
  }

  const NeighbourGrid& grid_;
  std::int32_t fast_cells_, slow_cells_;
  double reach_;
  float chord_, chord_margin_;
};

}  // namespace shoal::kernel
