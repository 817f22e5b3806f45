// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Full neighbour lists in compressed rows: for each particle of one body all particles of another (or of its own)
// nearer than the cut-off. Nothing but indices is stored; pair loops compute the geometry anew, which is faster than
// reading it back (PairOperator in the SDK).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "kernel/neighbours/aligned_buffer.hpp"
#include "kernel/neighbours/neighbour_grid.hpp"

namespace shoal::kernel {

/// Which instructions test candidates. `fastest` is what this program was compiled for; the others exist for tests.
enum class ScanPath { fastest, plain, avx2, avx512 };
bool is_available(ScanPath path);

class NeighbourList {
 public:
  /// Rows are padded to a multiple of this many entries, for plugins of any lane width up to it.
  static constexpr std::size_t padding = 8;

  /// Row i becomes the sources j with |x_j - x_i| < cutoff, for all targets i. If `same_body` the targets are the
  /// first of the sources, and a particle is not its own neighbour. `cutoff` must not exceed that of the grid.
  ///
  /// A row lists its neighbours cell by cell as the grid orders them. It does not depend on the number of threads.
  /// Targets whose position is not finite get an empty row. Memory is kept from build to build.
  void build(const NeighbourGrid& sources, Positions targets, double cutoff, bool same_body,
             ScanPath path = ScanPath::fastest);

  std::size_t n_rows() const { return n_rows_; }
  /// Sum of all counts.
  std::uint64_t n_pairs() const { return n_pairs_; }
  double cutoff() const { return cutoff_; }

  /// Where row i begins, a multiple of `padding`; n_rows() + 1 entries, the last one is the end of all rows.
  const std::uint64_t* offsets() const { return offsets_.data(); }
  /// True neighbours of row i.
  const std::uint32_t* counts() const { return counts_.data(); }
  /// Aligned to 64 bytes. Behind its true neighbours a row repeats the last one, so that every entry is valid.
  const std::uint32_t* indices() const { return indices_.data(); }

  std::size_t memory_bytes() const;

 private:
  struct Block;
  template <int D, class Scan>
  void build_rows(const NeighbourGrid& sources, Positions targets, bool same_body);
  template <class FillRows>
  void build_serial(const FillRows& fill_rows);
  template <class FillRows>
  void build_parallel(const FillRows& fill_rows);
  template <class FillRows>
  void reserve_first(const FillRows& fill_rows);

  std::size_t n_rows_ = 0;
  std::uint64_t n_pairs_ = 0;
  double cutoff_ = 0.0;
  AlignedBuffer<std::uint64_t> offsets_;
  AlignedBuffer<std::uint32_t> counts_, indices_, sample_;
};

}  // namespace shoal::kernel
