// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The rows of a neighbour list of as many particles as a pack has lanes, read side by side: column m holds neighbour m of
// each of them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "shoal/abi.h"
#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace pair_loop {

class RowGroup {
 public:
  // Rows index[0] ... index[n - 1]; the other lanes are empty.
  RowGroup(const shoal_neighbours& list, const std::uint32_t* index, int n) {
    alignas(64) double counts[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::uint32_t count = lane < n ? list.counts[index[lane]] : 0;
      counts[lane] = count;
      longest_ = std::max(longest_, count);
      // Of a row without neighbours particle 0 is read, and not used.
      rows_[lane] = count == 0 ? nobody : list.indices + list.offsets[index[lane]];
      last_[lane] = count == 0 ? 0 : (count + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING - lanes;
    }
    counts_ = Pack::load(counts);
  }

  std::uint32_t longest() const { return longest_; }
  // Makes columns m ... m + lanes - 1 (m a multiple of lanes) readable.
  void transpose(std::uint32_t m) {
    const std::uint32_t* row[lanes];
    for (int lane = 0; lane < lanes; ++lane) row[lane] = rows_[lane] + std::min(m, last_[lane]);
    simd::transpose(row, columns_);
  }
  // The column m + c.
  IndexPack column(std::uint32_t c) const { return IndexPack::load(columns_ + c * lanes); }
  Mask lanes_longer_than(std::uint32_t m) const { return Pack(static_cast<double>(m)) < counts_; }

 private:
  static constexpr std::uint32_t nobody[SHOAL_PADDING] = {};

  Pack counts_;
  std::uint32_t longest_ = 0;
  const std::uint32_t* rows_[lanes];
  std::uint32_t last_[lanes];
  alignas(64) std::uint32_t columns_[lanes * lanes];
};

}  // namespace pair_loop
}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
