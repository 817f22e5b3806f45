// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The monotone scheme as a limited mixture (flux correction: Zalesak 1979, J. Comput. Phys. 31, 335; in algebraic form:
// Kuzmin 2009, J. Comput. Phys. 228, 2517) of the accurate weights h_ij (fit.hpp) and of the non-negative ones l_ij
// (monotone.hpp), which add diffusion:
//   dc_i/dt = sum_j (l_ij + alpha_ij a_ij) (c_j - c_i),   a_ij = h_ij - l_ij,   0 <= alpha_ij = alpha_ji <= 1
// With L the rate by l_ij alone, P+ and P- the sums of the positive and of the negative a_ij (c_j - c_i), c_max and c_min
// over i and its neighbours, and k = 2.5 sum_j l_ij:
//   R+ = min(1, max(0, k (c_max - c_i) - L) / P+),  R- = min(1, max(0, L - k (c_min - c_i)) / -P-)
//   alpha_ij = min(R+_i, R-_j) where a_ij (c_j - c_i) > 0, else min(R-_i, R+_j)
// so that the whole rate stays within k (c_min - c_i) ... k (c_max - c_i): a largest value does not grow, a smallest one
// does not shrink. Where the accurate rate does that by itself, at peaks and ridges that decay, nothing is limited. Pairs
// exchange what they exchange with l and h alone, so contents are kept as well. Surface points are limited by R_i.
// A step of Euler's method with dt <= 1/k makes no new extremum, nor does Heun's, which is the mean of c and of two of them
// (Shu, Osher 1988): rk2 and auto take no longer ones. rkl2 does, and has no such proof: on fibres_1000 with a smoothing
// ratio of 1.6 it undershoots by 0.5 %.
// A smaller k limits smooth slopes: with sum_j l_ij / 2 a fifth of what spreads along the fibres of
// cases/diffusion/fibres_1000 is lost.
#pragma once

#include <algorithm>
#include <memory>

#include "stencil.hpp"

namespace shoal::diffusion {

inline std::string rise_of(const std::string& field) { return field + "_rise"; }
inline std::string fall_of(const std::string& field) { return field + "_fall"; }

namespace impl {

// What surface point w adds to the rate of particle i by the non-negative weights, and how much more by the accurate ones.
struct SurfaceRate {
  double low, more;
};
template <class Data>
SurfaceRate surface_rate(const SurfaceWeight& w, const Data& data, double c_i) {
  if (!data) return {0.0, 0.0};
  const double g =
      w.relation < 0 ? data->data()[w.j] : data->of_neighbours(static_cast<std::size_t>(w.relation))[w.j];
  return {w.per_data * g - w.per_value * c_i, w.more_per_data * g - w.more_per_value * c_i};
}

}  // namespace impl

// What both passes need.
struct LimiterPass : RowOperator {
  In<Scalar> value{"value"};
  std::unique_ptr<In<Scalar>> data;  // of surfaces; null: there is none

  std::shared_ptr<const Stencil> stencil;
  Names names;

  void set_weights(const std::string& field, std::shared_ptr<const Stencil> weights, bool has_data) {
    value.rename(names.keep(field));
    if (has_data) data = std::make_unique<In<Scalar>>(names.keep(surface_data_of(field)));
    stencil = std::move(weights);
  }

 protected:
  // Calls work(w) for the surface points of particle i; `next` runs through those of the chunk, which are sorted by i.
  template <class Work>
  void for_surface(const shoal_chunk& chunk, std::uint64_t i, std::size_t& next, Work&& work) const {
    const std::vector<SurfaceWeight>& all = stencil->surface[chunk.number];
    for (; next < all.size() && all[next].i == i; ++next) work(all[next]);
  }
};

// R+ and R- of each particle.
struct LimiterBounds : LimiterPass {
  Out<Scalar> rise{"rise", doc("Share of what raises the value that the limiter lets through."), derived};
  Out<Scalar> fall{"fall", doc("Share of what lowers the value that the limiter lets through."), derived};

  void set(const std::string& field, std::shared_ptr<const Stencil> weights, bool has_data) {
    set_weights(field, std::move(weights), has_data);
    rise.rename(names.keep(rise_of(field)));
    fall.rename(names.keep(fall_of(field)));
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    std::size_t next = 0;
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      Sums s = of_pairs(i);
      for_surface(chunk, i, next, [&](const SurfaceWeight& w) { add_surface(w, value.data()[i], s); });
      const double k = limiter_bound * s.weights;
      const double up = std::max(0.0, k * s.highest - s.low), down = std::max(0.0, s.low - k * s.lowest);
      rise.data()[i] = up < s.raised ? up / s.raised : 1.0;
      fall.data()[i] = down < -s.lowered ? down / -s.lowered : 1.0;
    }
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }

 private:
  struct Sums {
    double low = 0, weights = 0, raised = 0, lowered = 0;  // L, sum of l, P+, P-
    double highest = 0, lowest = 0;                        // of c_j - c_i
  };
  Sums of_pairs(std::uint64_t i) const {
    const double c_i = value.data()[i];
    Pack low(0.0), weights(0.0), raised(0.0), lowered(0.0), highest(0.0), lowest(0.0);
    for (std::size_t k = 0; k < n_relations(); ++k) {
      const shoal_neighbours& list = neighbours(k);
      const std::uint32_t* row = list.indices + list.offsets[i];
      const double* l = stencil->weights[k].data() + list.offsets[i];
      const double* more = stencil->more[k].data() + list.offsets[i];
      const double* c = value.of_neighbours(k);
      for (std::uint32_t m = 0; m < list.counts[i]; m += lanes) {
        const Pack d = gather<1, 0>(c, IndexPack::load(row + m)) - c_i;
        const Pack l_m = Pack::load(l + m), f = Pack::load(more + m) * d;
        low += l_m * d;
        weights += l_m;
        raised += max(Pack(0.0), f);
        lowered += min(Pack(0.0), f);
        highest = max(highest, d);
        lowest = min(lowest, d);
      }
    }
    return {horizontal_sum(low),     horizontal_sum(weights), horizontal_sum(raised),
            horizontal_sum(lowered), horizontal_max(highest), horizontal_min(lowest)};
  }
  void add_surface(const SurfaceWeight& w, double c_i, Sums& s) const {
    const auto [low, more] = impl::surface_rate(w, data, c_i);
    s.low += low;
    s.weights += w.per_value;
    s.raised += std::max(0.0, more);
    s.lowered += std::min(0.0, more);
    if (!(w.per_value > 0.0)) return;
    s.highest = std::max(s.highest, low / w.per_value);  // the data minus c_i
    s.lowest = std::min(s.lowest, low / w.per_value);
  }
};

// Adds the limited rate.
struct ApplyLimited : LimiterPass {
  In<Scalar> rise{"rise"}, fall{"fall"};
  Accumulate<Scalar> rate{"rate", derived};

  void set(const std::string& field, std::shared_ptr<const Stencil> weights, bool has_data) {
    set_weights(field, std::move(weights), has_data);
    rise.rename(names.keep(rise_of(field)));
    fall.rename(names.keep(fall_of(field)));
    rate.rename(names.keep(rate_of(field)));
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    std::size_t next = 0;
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      double sum = of_pairs(i);
      for_surface(chunk, i, next, [&](const SurfaceWeight& w) {
        const auto [low, more] = impl::surface_rate(w, data, value.data()[i]);
        sum += low + more * (more > 0.0 ? rise : fall).data()[i];
      });
      rate.data()[i] += sum;
    }
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }

 private:
  double of_pairs(std::uint64_t i) const {
    const double c_i = value.data()[i];
    const Pack rise_i(rise.data()[i]), fall_i(fall.data()[i]);
    Pack sum(0.0);
    for (std::size_t k = 0; k < n_relations(); ++k) {
      const shoal_neighbours& list = neighbours(k);
      const std::uint32_t* row = list.indices + list.offsets[i];
      const double* l = stencil->weights[k].data() + list.offsets[i];
      const double* more = stencil->more[k].data() + list.offsets[i];
      for (std::uint32_t m = 0; m < list.counts[i]; m += lanes) {
        const IndexPack j = IndexPack::load(row + m);
        const Pack d = gather<1, 0>(value.of_neighbours(k), j) - c_i, f = Pack::load(more + m) * d;
        const Pack if_raised = min(rise_i, gather<1, 0>(fall.of_neighbours(k), j));
        const Pack if_lowered = min(fall_i, gather<1, 0>(rise.of_neighbours(k), j));
        sum += Pack::load(l + m) * d + f * select(f > Pack(0.0), if_raised, if_lowered);
      }
    }
    return horizontal_sum(sum);
  }
};

}  // namespace shoal::diffusion
