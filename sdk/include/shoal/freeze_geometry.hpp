// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Freezes the geometry of pairs for the sub-steps of a step (detail/frozen_geometry.hpp says what is kept). Operators of
// the sub-steps that share `single` read it in place of positions, in two dimensions:
//
//     const auto single = std::make_shared<SinglePrecision>();
//     const auto share = [&](auto& op) { op.single = single; };
//     if (b.dimensions() == 2) b.attach<FreezeGeometry>("fluid.pair_geometry", {"advection", "geometry"}, target, share);
//     b.attach<PressureForce>("fluid.pressure_force", {"acoustic", "momentum"}, target, share);
//
// Distances are those of the middle of the step, r_ij + (dt/2) v_ij, with an error of the second order in dt: taken from
// its beginning they would lag behind what turns and what comes closer. Attach it in the loop whose steps are sub-cycled,
// after what sets volumes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "shoal/pair_operator.hpp"
#include "shoal/single_precision.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

struct FreezeGeometry : PairOperator<FreezeGeometry> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};

  std::shared_ptr<SinglePrecision> single;

  void begin() { single->frozen.follow(lists(), n_particles(), dimensions()); }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    with_own_kernel<D>([&](const auto& kernel) { freeze<D>(kernel, chunk); });
  }
  // There is one form only: what is written is read in packs.
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }
  std::uint32_t bytes_per_pair() const { return static_cast<std::uint32_t>(4 * (2 + dimensions())); }

 private:
  template <int D, class Kernel>
  [[gnu::noinline, gnu::flatten]] void freeze(const Kernel& kernel, const shoal_chunk& chunk) const {
    FrozenGeometry& geometry = single->frozen;
    const std::uint64_t end = geometry.first_group(chunk.end);
    for (std::uint64_t group = geometry.first_group(chunk.begin); group < end; ++group)
      for (std::size_t k = 0; k < n_relations(); ++k) freeze_group<D>(kernel, geometry, k, group);
  }

  // `lanes` rows of a group. Lanes beyond its particles read the group's first ones and weigh nothing.
  template <int D>
  struct Half {
    std::uint32_t index[lanes];
    pair_loop::RowGroup rows;

    Half(const shoal_neighbours& list, std::uint64_t group, int begin, int n_rows)
        : rows(list, numbered(group * single_lanes + static_cast<std::uint64_t>(n_rows > begin ? begin : 0)),
               std::clamp(n_rows - begin, 0, lanes)) {}

   private:
    const std::uint32_t* numbered(std::uint64_t first) {
      for (int lane = 0; lane < lanes; ++lane)
        index[lane] = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(lane);
      return index;
    }
  };

  template <int D, class Kernel>
  void freeze_group(const Kernel& kernel, FrozenGeometry& geometry, std::size_t k,
                    std::uint64_t group) const {
    const int n_rows = geometry.rows_in(group);
    Half<D> low(neighbours(k), group, 0, n_rows), high(neighbours(k), group, lanes, n_rows);
    FrozenGeometry::Column column = geometry.columns(k, group);
    const auto n_columns = static_cast<std::uint32_t>(geometry.n_columns(k, group));
    for (std::uint32_t m = 0; m < n_columns; m += lanes) {
      low.rows.transpose(m);
      high.rows.transpose(m);
      const std::uint32_t last = std::min<std::uint32_t>(lanes, n_columns - m);
      for (std::uint32_t c = 0; c < last; ++c, column.advance(D)) {
        freeze_lanes(kernel, k, low, m, c, column.neighbours, column.numbers);
        freeze_lanes(kernel, k, high, m, c, column.neighbours + lanes, column.numbers + lanes);
      }
    }
  }

  template <int D, class Kernel>
  void freeze_lanes(const Kernel& kernel, std::size_t k, const Half<D>& half, std::uint32_t m,
                    std::uint32_t c, std::uint32_t* indices, float* numbers) const {
    using Own = ParticlePack<D, true>;
    const double ahead = 0.5 * dt();
    const IndexPack j = half.rows.column(c);
    const PairFields<D, Pack, Own> p(k, Own{half.index}, j);
    const PairVector<D, Pack> r(p.i(position()) - p.j(position()) + ahead * (p.i(velocity) - p.j(velocity)));
    const Pack weight = (p.i(volume) * p.j(volume)) * kernel.dw_over_r(r.r());
    std::copy_n(j.lane, lanes, indices);
    select(half.rows.lanes_longer_than(m + c), weight, Pack(0.0)).store(numbers);
    for (int a = 0; a < D; ++a) r.r_ij()[a].store(numbers + (1 + a) * single_lanes);
  }
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
