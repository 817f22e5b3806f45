// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the code of a pair asks: geometry, and fields of the particle i and its neighbours j. R = double is one pair; in a
// Pack the lanes hold one particle and `lanes` of its neighbours (Own = Particle), or `lanes` particles with a neighbour
// each (Own = ParticlePack). SinglePair and FrozenPair are those of operators in single precision (single_precision.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "shoal/detail/single_records.hpp"
#include "shoal/operator.hpp"
#include "shoal/pack.hpp"
#include "shoal/single_pack.hpp"
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

// As many consecutive particles as a single pack has lanes: those from low and from high on.
template <int D>
struct SingleParticlePack {
  static constexpr int dimensions = D;
  std::uint64_t low, high;

  template <int N>
  void read(const double* field, SinglePack* out) const {
    Pack first[N], second[N];
    load_tuple<N>(field + low * N, first);
    load_tuple<N>(field + high * N, second);
    for (int k = 0; k < N; ++k) out[k] = SinglePack::join(first[k], second[k]);
  }
};

namespace pair_loop {

// What a field of T holds, of numbers that `numbers` writes.
template <class T, int D, class R, class F>
auto element(const F& numbers) {
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
    constexpr int n = field_numbers<T, D>;
    std::array<R, n> value;
    numbers(std::integral_constant<int, n>{}, value.data());
    return value;
  }
}

// The own values of the particle, or of those in the lanes.
template <class R, class T, bool Writable, class Own>
auto own_value(const Field<T, Writable>& field, const Own& i) {
  constexpr int D = Own::dimensions;
  if constexpr (std::is_same_v<Own, Particle<D>>)
    return field[i];
  else
    return element<T, D, R>(
        [&]<int N>(std::integral_constant<int, N>, R* out) { i.template read<N>(field.data(), out); });
}

}  // namespace pair_loop

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
    return pair_loop::own_value<R>(field, i_);
  }
  // The neighbours' values of a field.
  template <class T, bool Writable>
  auto j(const Field<T, Writable>& field) const {
    const double* values = field.of_neighbours(relation_);
    return pair_loop::element<T, D, R>(
        [&]<int N>(std::integral_constant<int, N>, R* out) { gather_tuple<N>(values, j_, out); });
  }

 private:
  std::size_t relation_;
  Own i_;
  Indices j_;
};

// The distance of a pair.
template <int D, class R>
class PairVector {
 public:
  PairVector() = default;
  explicit PairVector(const Vec<D, R>& r_ij) : r_ij_(r_ij) {
    // Coincident particles have no direction: what is added, nothing to others, makes e = 0 there, not NaN.
    R squared = std::is_same_v<R, SinglePack> ? 1e-36 : 1e-200;
    for (int a = 0; a < D; ++a) squared += r_ij_[a] * r_ij_[a];
    if constexpr (simd::fast_inverse_sqrt && !std::is_same_v<R, double>) {
      per_r_ = inverse_sqrt(squared);
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

// The fields of a pair in single precision; View is a RecordView. Those that the operator lists are rounded, of the
// particle as of its neighbours.
template <int D, class Own, class View>
class SinglePairFields {
 public:
  static constexpr int dimensions = D;
  using RealType = SinglePack;
  using OwnRecord = pair_loop::OwnRecord<View, Own>;

  SinglePairFields(const View& view, const OwnRecord& own, SingleIndexPack j)
      : view_(view), own_(own), j_(j) {}

  template <class T, bool Writable>
  auto i(const Field<T, Writable>& field) const {
    return pair_loop::element<T, D, SinglePack>([&]<int N>(std::integral_constant<int, N>, SinglePack* out) {
      const bool listed =
          view_.template find<N>(field, [&](auto place) { std::copy_n(own_.values + place, N, out); });
      if (!listed) pair_loop::read_own<N>(field, own_.i, out);
    });
  }
  template <class T, bool Writable>
  auto j(const Field<T, Writable>& field) const {
    return pair_loop::element<T, D, SinglePack>([&]<int N>(std::integral_constant<int, N>, SinglePack* out) {
      view_.template gather<N>(field, j_, out);
    });
  }

 private:
  const View& view_;
  const OwnRecord& own_;
  SingleIndexPack j_;
};

// A particle and `single_lanes` of its neighbours. The kernel is that of h = 1, so that numbers of very small or large
// particles stay within the range of single precision.
template <int D, class Kernel, class View>
class SinglePair : public SinglePairFields<D, Particle<D>, View>, public PairVector<D, SinglePack> {
 public:
  // The particle's own record, with its geometry.
  struct Own : pair_loop::OwnRecord<View, Particle<D>> {
    SinglePack geometry[4];
    // Times h^(D - 2), so that V_i V_j (dW/dr)/r is it times V_j / h^D times (dW/dr)/r of h = 1.
    SinglePack volume;
    using pair_loop::OwnRecord<View, Particle<D>>::read;
    void read(const View& view, Particle<D> i) {
      pair_loop::OwnRecord<View, Particle<D>>::read(view, i);
      view.own_geometry(i.index, geometry);
    }
  };
  struct Scales {
    double unit;                         // of positions, m
    double h;                            // m
    const Field<Scalar, false>* volume;  // nullptr: not asked for
  };

  // Distances, and the volume of the neighbours over h^D. It is found for several packs before what follows from it: that
  // depends on it through a long chain of operations, of which the processor has several under way then.
  class Geometry : public PairVector<D, SinglePack> {
   public:
    Geometry() = default;
    Geometry(const View& view, const Scales& scales, const Own& own, SingleIndexPack j)
        : Geometry(scales.unit, own.geometry, Record(view, j)) {}
    SinglePack volume;

   private:
    struct Record {
      SinglePack geometry[4];
      Record(const View& view, SingleIndexPack j) { view.gather_geometry(j, geometry); }
    };
    Geometry(double unit, const SinglePack* own, const Record& record)
        : PairVector<D, SinglePack>(distance(unit, own, record.geometry)), volume(record.geometry[3]) {}
  };

  SinglePair(const Kernel& unit_kernel, const View& view, const Scales& scales, const Own& own,
             SingleIndexPack j, const Geometry& geometry)
      : SinglePairFields<D, Particle<D>, View>(view, own, j),
        PairVector<D, SinglePack>(geometry),
        unit_kernel_(unit_kernel),
        scales_(scales),
        own_volume_(own.volume),
        volume_(geometry.volume) {}

  template <class T, bool Writable>
  auto j(const Field<T, Writable>& field) const {
    if constexpr (std::is_same_v<T, Scalar> && !Writable)
      if (&field == scales_.volume) return (1.0 / per_volume()) * volume_;
    return SinglePairFields<D, Particle<D>, View>::j(field);
  }

  SinglePack W() const { return per_volume() * unit_kernel_.w(q()); }
  SinglePack dW() const { return (per_volume() / scales_.h) * unit_kernel_.dw(q()); }
  SinglePack dW_over_r() const {
    return (per_volume() / (scales_.h * scales_.h)) * unit_kernel_.dw_over_r(q());
  }
  Vec<D, SinglePack> grad_W() const { return dW_over_r() * this->r_ij(); }
  double h() const { return scales_.h; }
  template <class Volume>
  SinglePack weight(const Volume&) const {
    return (own_volume_ * volume_) * unit_kernel_.dw_over_r(q());
  }

 private:
  static Vec<D, SinglePack> distance(double unit, const SinglePack* x_i, const SinglePack* x_j) {
    Vec<D, SinglePack> r_ij;
    for (int a = 0; a < D; ++a)
      r_ij[a] = unit * SinglePack::from_raw(simd::single::difference(x_i[a].v, x_j[a].v));
    return r_ij;
  }
  SinglePack q() const { return (1.0 / scales_.h) * this->r(); }
  double per_volume() const { return detail::per_volume<D>(scales_.h); }

  const Kernel& unit_kernel_;
  const Scales& scales_;
  SinglePack own_volume_;  // Own::volume
  SinglePack volume_;      // over h^D
};

// Pairs of frozen geometry, of `single_lanes` particles with a neighbour each.
template <int D, class View>
class FrozenPair : public SinglePairFields<D, SingleParticlePack<D>, View>, public PairVector<D, SinglePack> {
 public:
  using Own = pair_loop::OwnRecord<View, SingleParticlePack<D>>;

  FrozenPair(double h, const View& view, const Own& own, const std::uint32_t* neighbours,
             const float* numbers)
      : SinglePairFields<D, SingleParticlePack<D>, View>(view, own, {neighbours, neighbours + lanes}),
        PairVector<D, SinglePack>(distance(numbers)),
        h_(h),
        weight_(SinglePack::load(numbers)) {}

  double h() const { return h_; }
  // V_i V_j (dW/dr)/r as it was when the geometry was frozen.
  template <class Volume>
  SinglePack weight(const Volume&) const {
    return weight_;
  }

 private:
  static Vec<D, SinglePack> distance(const float* numbers) {
    Vec<D, SinglePack> r_ij;
    for (int a = 0; a < D; ++a) r_ij[a] = SinglePack::load(numbers + (1 + a) * single_lanes);
    return r_ij;
  }

  double h_;
  SinglePack weight_;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
