// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Which runs of sorted particles may hold neighbours of a place: at most three cells of each slow axis, and along the
// fast axis the chord that a ball of the cut-off cuts out of each. Included by neighbour_list.cpp only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__SSE4_1__)
#include <immintrin.h>
#endif

#include "kernel/neighbours/neighbour_grid.hpp"
#include "kernel/neighbours/row_scan.hpp"

namespace shoal::kernel {

template <int D>
class RunFinder {
 public:
  static constexpr std::size_t max_runs = D == 2 ? 3 : 9;

  RunFinder(const NeighbourGrid& grid, double cutoff)
      : fast_(grid.map(0)),
        cell_start_(grid.cell_start()),
        fast_cells_(grid.map(0).cells()),
        slow_cells_(grid.map(1).cells()),
        rounding_(grid.rounding()),
        reach_(cutoff + rounding_) {
    for (int rank = 0; rank < D; ++rank) axis_[rank] = grid.axis(rank);
    for (int rank = 1; rank < D; ++rank) slow_[rank - 1] = &grid.map(rank);
    chord_ = static_cast<float>(reach_ * fast_.per_cell() * (1.0 + 1e-6));
    chord_margin_ = static_cast<float>(1e-4 + rounding_ * fast_.per_cell());
  }

  /// Fills `runs`, in ascending order of place, and returns their number. The place is finite.
  ///
  /// Chords are computed in single precision, relative to the cell of the place: four at once. Margins of
  /// 1e-5 in the squares and 1e-4 cells cover its rounding, so that no neighbour is missed.
  std::size_t find(const double* x, std::array<Run, max_runs>& runs) const {
    const double u = fast_.locate(x[axis_[0]]);
    const double whole = std::floor(u);
    const SlowCells rows(*slow_[0], x[axis_[1]], rounding_, reach_);
    // A place far outside of the grid has no cell that fits 32 bits, and no neighbours.
    const double limit = static_cast<double>(fast_.cells()) + 2.0 * chord_;
    const Chord chord{static_cast<std::int32_t>(std::clamp(whole, -limit, limit)),
                      static_cast<float>(u - whole)};
    if constexpr (D == 2) return add_runs(chord, rows, 0.0f, 0, runs.data(), 0);
    std::size_t n = 0;
    if constexpr (D == 3) {
      const SlowCells slabs(*slow_[1], x[axis_[2]], rounding_, reach_);
      for (int k = 0; k < 3; ++k)
        n = add_runs(chord, rows, slabs.squared_gap[k], slabs.cell[k] * slow_cells_, runs.data(), n);
    }
    return n;
  }

 private:
  // The three cells of a slow axis around a place, with the squares of the distances to them over the reach. A slow
  // cell is no narrower than the cut-off, so there is nothing to find in others. Cells outside of the grid are
  // replaced by cell 0 at a large distance; so is the fourth, which only fills a vector.
  struct SlowCells {
    alignas(16) float squared_gap[4] = {0.0f, 0.0f, 0.0f, 4.0f};
    std::int64_t cell[3];

    SlowCells(const AxisMap& map, double x, double rounding, double reach) {
      const double u = map.locate(x), whole = std::floor(u);
      const double width = map.cell_width(), per_reach = 1.0 / reach;
      const double below = std::max(0.0, (u - whole) * width - rounding) * per_reach;
      const double above = std::max(0.0, (1.0 - (u - whole)) * width - rounding) * per_reach;
      squared_gap[0] = static_cast<float>(below * below);
      squared_gap[2] = static_cast<float>(above * above);
      const auto middle = static_cast<std::int64_t>(whole);
      for (int j = 0; j < 3; ++j) {
        cell[j] = middle + j - 1;
        const bool inside = cell[j] >= 0 && cell[j] < map.cells();
        cell[j] = inside ? cell[j] : 0;
        squared_gap[j] = inside ? squared_gap[j] : 4.0f;
      }
    }
  };

  // Where a place stands on the fast axis: its cell and the fraction of a cell beyond.
  struct Chord {
    std::int32_t cell;
    float fraction;
  };

  // Adds the runs of the three rows of a slab that begins with row `first_row`.
  std::size_t add_runs(Chord chord, const SlowCells& rows, float slab_gap, std::int64_t first_row, Run* runs,
                       std::size_t n) const {
    alignas(16) std::int32_t begin[4], end[4];
    cut_chords(chord, rows, slab_gap, begin, end);
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t* row = cell_start_ + (first_row + rows.cell[j]) * fast_cells_;
      runs[n] = {row[begin[j]], row[end[j]]};
      n += runs[n].begin < runs[n].end;
    }
    return n;
  }

#if defined(__SSE4_1__)
  void cut_chords(Chord chord, const SlowCells& rows, float slab_gap, std::int32_t* begin,
                  std::int32_t* end) const {
    const __m128 rest = _mm_sub_ps(_mm_set1_ps(1.0f + 1e-5f - slab_gap), _mm_load_ps(rows.squared_gap));
    const __m128 root = _mm_sqrt_ps(_mm_max_ps(rest, _mm_setzero_ps()));
    const __m128 half = _mm_add_ps(_mm_mul_ps(root, _mm_set1_ps(chord_)), _mm_set1_ps(chord_margin_));
    const __m128 fraction = _mm_set1_ps(chord.fraction);
    const __m128i cell = _mm_set1_epi32(chord.cell), cells = _mm_set1_epi32(static_cast<int>(fast_cells_));
    const auto limited = [&](__m128i c) {
      return _mm_min_epi32(_mm_max_epi32(c, _mm_setzero_si128()), cells);
    };
    const __m128i first =
        limited(_mm_add_epi32(cell, _mm_cvttps_epi32(_mm_floor_ps(_mm_sub_ps(fraction, half)))));
    const __m128i last = _mm_cvttps_epi32(_mm_floor_ps(_mm_add_ps(fraction, half)));
    const __m128i behind = limited(_mm_add_epi32(_mm_add_epi32(cell, last), _mm_set1_epi32(1)));
    // Where nothing is left of the reach the run ends where it begins.
    const __m128 some = _mm_cmpgt_ps(rest, _mm_setzero_ps());
    _mm_store_si128(reinterpret_cast<__m128i*>(begin), first);
    _mm_store_si128(reinterpret_cast<__m128i*>(end), _mm_blendv_epi8(first, behind, _mm_castps_si128(some)));
  }
#else
  void cut_chords(Chord chord, const SlowCells& rows, float slab_gap, std::int32_t* begin,
                  std::int32_t* end) const {
    const auto cells = static_cast<std::int32_t>(fast_cells_);
    for (int j = 0; j < 4; ++j) {
      const float rest = 1.0f + 1e-5f - slab_gap - rows.squared_gap[j];
      const float half = std::sqrt(std::max(0.0f, rest)) * chord_ + chord_margin_;
      const auto first = static_cast<std::int32_t>(std::floor(chord.fraction - half));
      const auto last = static_cast<std::int32_t>(std::floor(chord.fraction + half));
      begin[j] = std::clamp(chord.cell + first, 0, cells);
      end[j] = rest > 0.0f ? std::clamp(chord.cell + last + 1, 0, cells) : begin[j];
    }
  }
#endif

  const AxisMap& fast_;
  const AxisMap* slow_[D - 1];
  const std::uint32_t* cell_start_;
  std::int64_t fast_cells_, slow_cells_;
  double rounding_, reach_;
  float chord_, chord_margin_;
  int axis_[D];
};

}  // namespace shoal::kernel
