// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The geometry of pairs, frozen while a step is sub-cycled: positions change little then, and two passes over pairs in each
// sub-step need not find distances and smoothing kernels anew. FreezeGeometry (freeze_geometry.hpp) writes it once in an
// outer step; operators with a member `single` read it in 2D (pair_operator.hpp).
//
// Rows lie side by side: the pairs of `single_lanes` particles stand in columns, one pair of each of them. A column holds the
// neighbours' indices and, in single precision, V_i V_j W'(r)/r and r_i - r_j: 16 bytes a pair in 2D. Rounding is the same
// for (i, j) and (j, i), so that what pairs exchange stays opposite to the last bit. Lanes beyond a row have the weight 0.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shoal/abi.h"
#include "shoal/single_pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

class FrozenGeometry {
 public:
  // One pair of each of `single_lanes` particles.
  struct Column {
    std::uint32_t* neighbours;  // [lane]
    float* numbers;             // [lane] the weight, then each component of the distance

    void advance(int dimensions) {
      neighbours += single_lanes;
      numbers += (1 + dimensions) * single_lanes;
    }
  };

  // [main] Makes room for the rows of the lists, each a relation of its own.
  void follow(const std::vector<shoal_neighbours>& lists, std::uint64_t n_particles, int dimensions) {
    n_rows_ = n_particles;
    for (const shoal_neighbours& list : lists) n_rows_ = std::min(n_rows_, list.n_rows);
    numbers_per_column_ = static_cast<std::size_t>((1 + dimensions) * single_lanes);
    relations_.resize(lists.size());
    for (std::size_t k = 0; k < lists.size(); ++k)
      relations_[k].follow(lists[k], n_rows_, numbers_per_column_);
  }

  // Groups of `single_lanes` particles that follow one another; the last may have fewer. Those whose first particle is among
  // begin ... end - 1 are first_group(begin) ... first_group(end) - 1.
  std::uint64_t first_group(std::uint64_t begin) const {
    return (std::min(begin, n_rows_) + single_lanes - 1) / single_lanes;
  }
  int rows_in(std::uint64_t group) const {
    return static_cast<int>(std::min<std::uint64_t>(single_lanes, n_rows_ - group * single_lanes));
  }

  std::uint64_t n_columns(std::size_t relation, std::uint64_t group) const {
    const auto& first = relations_[relation].first;
    return first[group + 1] - first[group];
  }
  Column columns(std::size_t relation, std::uint64_t group) {
    Relation& r = relations_[relation];
    const std::uint64_t first = r.first[group];
    return {r.neighbours.data() + first * single_lanes, r.numbers.data() + first * numbers_per_column_};
  }

 private:
  struct Relation {
    std::vector<std::uint64_t> first;  // [group] its first column
    std::vector<std::uint32_t> neighbours;
    std::vector<float> numbers;

    void follow(const shoal_neighbours& list, std::uint64_t n_rows, std::size_t numbers_per_column) {
      first.assign(1, 0);
      for (std::uint64_t row = 0; row < n_rows; row += single_lanes) {
        const std::uint32_t* counts = list.counts + row;
        first.push_back(first.back() + *std::max_element(counts, counts + std::min<std::uint64_t>(
                                                                              single_lanes, n_rows - row)));
      }
      if (neighbours.size() >= first.back() * single_lanes) return;
      const std::uint64_t room =
          first.back() + first.back() / 16;  // the number of pairs changes from step to step
      neighbours.resize(room * single_lanes);
      numbers.resize(room * numbers_per_column);
    }
  };

  std::uint64_t n_rows_ = 0;
  std::size_t numbers_per_column_ = 0;
  std::vector<Relation> relations_;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
