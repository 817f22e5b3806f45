// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Freezes the geometry of pairs for the sub-steps of a step (detail/frozen_geometry.hpp says what is kept). Where `geometry`
// is shared with operators of the sub-steps, these read it in place of positions:
//
//     const auto geometry = std::make_shared<FrozenGeometry>();
//     const auto share = [&](auto& op) { op.geometry = geometry; };
//     b.attach<FreezeGeometry>("fluid.pair_geometry", {"advection", "geometry"}, target, share);
//     b.attach<PressureForce>("fluid.pressure_force", {"acoustic", "momentum"}, target, share);
//
// Distances are those of the middle of the step, r_ij + (dt/2) v_ij, with an error of the second order in dt: taken from
// its beginning they would lag behind what turns and what comes closer. Momentum is kept to rounding, angular momentum to
// that error. Attach it in the loop whose steps are sub-cycled, after what sets volumes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "shoal/pair_operator.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

struct FreezeGeometry : PairOperator<FreezeGeometry> {
  In<Vector> velocity{"velocity"};
  In<Scalar> volume{"volume"};

  std::shared_ptr<FrozenGeometry> geometry;

  void begin() { geometry->follow(lists(), n_particles(), dimensions()); }

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
    const std::uint64_t end = geometry->first_group(chunk.end);
    for (std::uint64_t group = geometry->first_group(chunk.begin); group < end; ++group) {
      std::uint32_t index[lanes];
      for (int lane = 0; lane < lanes; ++lane)
        index[lane] = static_cast<std::uint32_t>(group * lanes) + static_cast<std::uint32_t>(lane);
      for (std::size_t k = 0; k < n_relations(); ++k) freeze_group<D>(kernel, k, group, index);
    }
  }

  template <int D, class Kernel>
  void freeze_group(const Kernel& kernel, std::size_t k, std::uint64_t group,
                    const std::uint32_t* index) const {
    using Own = ParticlePack<D, true>;
    const double ahead = 0.5 * dt();
    pair_loop::RowGroup rows(neighbours(k), index, geometry->rows_in(group));
    FrozenGeometry::Column column = geometry->columns(k, group);
    for (std::uint32_t m = 0; m < rows.longest(); m += lanes) {
      rows.transpose(m);
      const std::uint32_t last = std::min<std::uint32_t>(lanes, rows.longest() - m);
      for (std::uint32_t c = 0; c < last; ++c) {
        const IndexPack j = rows.column(c);
        const PairFields<D, Pack, Own> p(k, Own{index}, j);
        const PairVector<D, Pack> r(p.i(position()) - p.j(position()) +
                                    ahead * (p.i(velocity) - p.j(velocity)));
        const Pack weight = (p.i(volume) * p.j(volume)) * kernel.dw_over_r(r.r());
        std::copy_n(j.lane, lanes, column.neighbours);
        select(rows.lanes_longer_than(m + c), weight, Pack(0.0)).store(column.numbers);
        for (int a = 0; a < D; ++a) r.r_ij()[a].store(column.numbers + (1 + a) * lanes);
        column.advance(D);
      }
    }
  }
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
