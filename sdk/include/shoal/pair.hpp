// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the code of a pair asks: geometry, and fields of the particle i and its neighbours j. R = double is one pair; in a
// Pack the lanes hold one particle and `lanes` of its neighbours (Own = Particle), or `lanes` particles with a neighbour
// each (Own = ParticlePack).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "shoal/operator.hpp"
#include "shoal/pack.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "shoal/vec.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

// Particles, one in each lane: `index` of them, which follow one another or not.
template <int D, bool Consecutive>
struct ParticlePack {
  static constexpr int dimensions = D;
  const std::uint32_t* index;

  // The N numbers of each particle; of consecutive ones only index[0] is looked at. These are loads that the compiler can
  // take out of the loop over neighbours.
  template <int N>
  void read(const double* field, Pack* out) const {
    if constexpr (Consecutive)
      load_tuple<N>(field + std::size_t{index[0]} * N, out);
    else
      for (int k = 0; k < N; ++k)
        out[k] = Pack::from([&](int lane) { return field[std::size_t{index[lane]} * N + std::size_t(k)]; });
  }
};

// The fields of a pair.
template <int D, class R, class Own>
class PairFields {
 public:
  static constexpr int dimensions = D;
  using RealType = R;
  using Indices = typename RealTraits<R>::IndexType;

  PairFields(std::size_t relation, Own i, Indices j) : relation_(relation), i_(i), j_(j) {}

  // The particle's own value of a field.
  template <class T, bool Writable>
  auto i(const Field<T, Writable>& field) const {
    if constexpr (std::is_same_v<Own, Particle<D>>)
      return field[i_];
    else
      return read<T>(
          [&]<int N>(std::integral_constant<int, N>, R* out) { i_.template read<N>(field.data(), out); });
  }
  // The neighbours' values of a field.
  template <class T, bool Writable>
  auto j(const Field<T, Writable>& field) const {
    const double* values = field.of_neighbours(relation_);
    return read<T>([&]<int N>(std::integral_constant<int, N>, R* out) { gather_tuple<N>(values, j_, out); });
  }

 private:
  // What a field holds, of numbers that `numbers` writes.
  template <class T, class F>
  static auto read(const F& numbers) {
    if constexpr (std::is_same_v<T, Scalar>) {
      R value;
      numbers(std::integral_constant<int, 1>{}, &value);
      return value;
    } else if constexpr (std::is_same_v<T, Vector>) {
      Vec<D, R> value;
      numbers(std::integral_constant<int, D>{}, value.e);
      return value;
    } else if constexpr (std::is_same_v<T, Matrix>) {
      Mat<D, R> value;
      numbers(std::integral_constant<int, D * D>{}, value.e);
      return value;
    } else {
      constexpr auto n = D == 2 ? impl::array_size<T>.in_2d : impl::array_size<T>.in_3d;
      std::array<R, n> value;
      numbers(std::integral_constant<int, static_cast<int>(n)>{}, value.data());
      return value;
    }
  }

  std::size_t relation_;
  Own i_;
  Indices j_;
};

// The distance of a pair; Single: of components in single precision.
template <int D, class R, bool Single = false>
class PairVector {
 public:
  explicit PairVector(const Vec<D, R>& r_ij) : r_ij_(r_ij) {
    // Coincident particles have no direction: the limit makes e = 0 there, not NaN.
    const R squared = max(R(1e-200), squared_norm(r_ij_));
    if constexpr (simd::fast_inverse_sqrt && !std::is_same_v<R, double>) {
      per_r_ = Single ? inverse_sqrt_single(squared) : inverse_sqrt(squared);
      r_ = squared * per_r_;
    } else {
      r_ = sqrt(squared);
      per_r_ = R(1.0) / r_;
    }
  }

  // Distance |r_i - r_j| in m.
  R r() const { return r_; }
  // 1 / r, which costs less than a division.
  R per_r() const { return per_r_; }
  // r_i - r_j in m.
  const Vec<D, R>& r_ij() const { return r_ij_; }
  // Unit vector from j to i.
  Vec<D, R> e() const { return per_r_ * r_ij_; }

 private:
  Vec<D, R> r_ij_;
  R r_, per_r_;
};

template <int D, class R, class Kernel, class Own = Particle<D>>
class Pair : public PairFields<D, R, Own>, public PairVector<D, R> {
 public:
  using typename PairFields<D, R, Own>::Indices;
  using OwnPosition = std::conditional_t<std::is_same_v<Own, Particle<D>>, Vec<D>, Vec<D, Pack>>;

  Pair(const Kernel& kernel, std::size_t relation, Own i, const OwnPosition& x_i,
       const double* x_of_neighbours, Indices j)
      : PairFields<D, R, Own>(relation, i, j),
        PairVector<D, R>(x_i - gather_vec<D>(x_of_neighbours, j)),
        kernel_(kernel) {}

  // Smoothing kernel in 1/m^D, its derivative dW/dr <= 0, (dW/dr)/r, and its gradient with respect to r_i.
  R W() const { return kernel_.w(this->r()); }
  R dW() const { return kernel_.dw(this->r()); }
  R dW_over_r() const { return kernel_.dw_over_r(this->r()); }
  Vec<D, R> grad_W() const { return dW_over_r() * this->r_ij(); }
  // Smoothing length in m.
  double h() const { return kernel_.h(); }
  // V_i V_j (dW/dr)/r: what a pair exchanges in a sum that conserves. `volume` holds the particle's and the neighbours'.
  template <class Volume>
  R weight(const Volume& volume) const {
    return (this->i(volume) * this->j(volume)) * dW_over_r();
  }

 private:
  const Kernel& kernel_;
};

// A pair of frozen geometry (shoal/freeze_geometry.hpp).
template <int D, class Own>
class FrozenPair : public PairFields<D, Pack, Own>, public PairVector<D, Pack, true> {
 public:
  FrozenPair(double h, std::size_t relation, Own i, const std::uint32_t* neighbours, const float* numbers)
      : PairFields<D, Pack, Own>(relation, i, IndexPack::load(neighbours)),
        PairVector<D, Pack, true>(distance(numbers)),
        h_(h),
        weight_(Pack::load(numbers)) {}

  double h() const { return h_; }
  // V_i V_j (dW/dr)/r as it was when the geometry was frozen.
  template <class Volume>
  Pack weight(const Volume&) const {
    return weight_;
  }

 private:
  static Vec<D, Pack> distance(const float* numbers) {
    Vec<D, Pack> r_ij;
    for (int a = 0; a < D; ++a) r_ij[a] = Pack::load(numbers + (1 + a) * lanes);
    return r_ij;
  }

  double h_;
  Pack weight_;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
