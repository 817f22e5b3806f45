// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A discrete operator as weights of pairs, kept beside the neighbour lists:
//   dc_i/dt = sum_j l_ij (c_j - c_i),   l_ij in 1/s
// They are computed where particles have moved (never again where they rest) and applied in each stage of the time
// integration: 12 bytes a pair are read, against a smoothing kernel, a root and a division that would be computed.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "shoal/operator.hpp"
#include "shoal/pack.hpp"
#include "shoal/particle_operator.hpp"
#include "species.hpp"

namespace shoal::diffusion {

// How often the particles of a body were found at new positions.
struct Motion {
  std::uint64_t count = 0;
  std::vector<double> seen;  // positions at the last look
};

// Looks whether the particles of a body have moved since it last looked.
struct WatchMotion : ParticleOperator<WatchMotion> {
  In<Vector> position{"position"};

  std::shared_ptr<Motion> motion;

  void begin() {
    const std::size_t n = n_particles() * static_cast<std::size_t>(dimensions());
    std::vector<double>& seen = motion->seen;
    if (seen.size() == n && std::memcmp(seen.data(), position.data(), n * sizeof(double)) == 0) return;
    seen.assign(position.data(), position.data() + n);
    ++motion->count;
  }
};

// What those who compute the weights and those who apply them share.
struct SurfaceWeight {
  std::uint32_t i, j;                            // the particle, and the one that carries the surface point
  std::int32_t relation;                         // of j; -1: the point is that of i itself
  double per_data, per_value;                    // dc_i/dt = per_data g_j - per_value c_i
  double more_per_data = 0, more_per_value = 0;  // as Stencil::more
};

inline constexpr double limiter_bound = 2.5;  // k over the sum of l (limiter.hpp)

struct Stencil {
  std::vector<std::vector<SurfaceWeight>> surface;  // [chunk]
  std::vector<std::vector<double>> weights;         // [relation][entry of the list], 0 in the padding
  std::vector<std::vector<double>> more;            // what the accurate weights are larger by (limiter.hpp)
  double spectral_radius = 0;                       // 1/s, largest magnitude of an eigenvalue
  std::vector<std::shared_ptr<const Motion>> motions;  // of the bodies of the relations
  std::vector<std::uint64_t> seen;                     // their counts when the weights were computed
  bool limited = false;                                // whether there are `more`
  double limiter_rate =
      0;  // 1/s, of limited ones: the largest k of limiter.hpp; 1/k is the longest step of Euler's
          // method that makes no new extremum

  std::vector<SurfaceWeight>& surface_of(const shoal_chunk& chunk) {
    if (chunk.number >= surface.size()) throw std::logic_error("more chunks of particles than expected");
    surface[chunk.number].clear();
    return surface[chunk.number];
  }
};

// Operators that look at whole rows of neighbours.
class RowOperator : public OperatorBase {
 public:
  static constexpr bool pairs = true;

 protected:
  RowOperator() : OperatorBase(true) {}
};

// If particles have moved since the weights were computed, makes room for those of all rows. Returns whether it did.
template <class Op>
bool renew_stencil(const Op& op, Stencil& stencil) {
  std::vector<std::uint64_t> counts;
  for (const auto& motion : stencil.motions) counts.push_back(motion->count);
  if (counts == stencil.seen) return false;
  stencil.seen = counts;
  stencil.weights.resize(op.n_relations());
  if (stencil.limited) stencil.more.resize(op.n_relations());
  stencil.surface.assign(op.n_particles() / 32 + 2, {});
  for (std::size_t k = 0; k < op.n_relations(); ++k) {
    const shoal_neighbours& list = op.neighbours(k);
    const std::uint64_t last = list.n_rows - 1;
    stencil.weights[k].assign(list.n_rows == 0 ? 0 : list.offsets[last] + list.counts[last] + SHOAL_PADDING,
                              0.0);
    if (!stencil.more.empty()) stencil.more[k].assign(stencil.weights[k].size(), 0.0);
  }
  return true;
}

// Adds sum_j l_ij (c_j - c_i) to the rate of c.
struct ApplyStencil : RowOperator {
  In<Scalar> value{"value"};
  Accumulate<Scalar> rate{"rate", derived};

  std::shared_ptr<const Stencil> stencil;
  Names names;

  void set(const std::string& field, std::shared_ptr<const Stencil> weights) {
    value.rename(names.keep(field));
    rate.rename(names.keep(rate_of(field)));
    stencil = std::move(weights);
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      const double c_i = value.data()[i];
      Pack sum(0.0);
      for (std::size_t k = 0; k < n_relations(); ++k) {
        const shoal_neighbours& list = neighbours(k);
        const std::uint32_t n = list.counts[i];
        const std::uint32_t* row = list.indices + list.offsets[i];
        const double* weight = stencil->weights[k].data() + list.offsets[i];
        const double* c = value.of_neighbours(k);
        for (std::uint32_t m = 0; m < n; m += lanes)
          sum = sum + Pack::load(weight + m) * (gather<1, 0>(c, IndexPack::load(row + m)) - c_i);
      }
      rate.data()[i] += horizontal_sum(sum);
    }
  }
  // One neighbour after the other: the reference for tests.
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < n_relations(); ++k)
        for (std::uint32_t m = 0; m < neighbours(k).counts[i]; ++m) {
          const std::uint64_t entry = neighbours(k).offsets[i] + m;
          const std::uint32_t j = neighbours(k).indices[entry];
          sum += stencil->weights[k][entry] * (value.of_neighbours(k)[j] - value.data()[i]);
        }
      rate.data()[i] += sum;
    }
  }
};

}  // namespace shoal::diffusion
