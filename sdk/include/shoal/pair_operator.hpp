// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators that sum over pairs of particles. The author writes the physics of one pair:
//
//     struct ViscousForce : shoal::PairOperator<ViscousForce> {
//       Param<double>      nu{"viscosity", "m2/s", "Kinematic viscosity.", positive};
//       In<Vector>         velocity{"velocity"};
//       In<Scalar>         volume{"volume"};
//       Accumulate<Vector> acceleration{"acceleration"};
//
//       auto pair(const auto& p) const {
//         return 2.0 * nu * p.j(volume) * p.dW() / (p.r() + 0.01 * p.h()) * (p.i(velocity) - p.j(velocity));
//       }
//       void particle(auto i, auto sum) const { acceleration[i] += sum; }
//     };
//
// `pair` is compiled for packs of neighbours (SIMD), for 2D and 3D and for each smoothing kernel; branch on data
// with select(condition, a, b). It returns a number, a Vec, a Mat, or sums(a, b, ...) of these, and `particle` gets
// their sums over all neighbours. The loop runs over the rows of the neighbour lists in their order, so results do
// not depend on the number of threads. Optional members as for ParticleOperator, and
//     static constexpr bool skips_lonely = true;
// for operators whose `particle` changes nothing when the sum is zero: particles without neighbours are passed over,
// which is most of them next to a wall.
//     static constexpr bool row_by_row = true;
// for operators whose `pair` reads many numbers of the particle itself, or wants each of them to be one number. Otherwise
// the lanes of a pack may be pairs of different particles (they are in 2D), and p.i(field) holds a value for each.
//     template <int D> using Kernel = WendlandC6<D>;
// ties the operator to one smoothing kernel (with the target's smoothing length) and compiles it for that alone.
//     static constexpr const char* pair_geometry = "reference_position";
// takes distances from another field than `position`.
//     std::shared_ptr<SinglePrecision> single;
// runs the operator in single precision where it is set, in some 70 % of the time (single_precision.hpp): `pair` may ask
// weight(volume), r(), r_ij() and their like, in 3D W() and its like too, and fields. With
//     static constexpr bool single_in_3d_only = true;
// it does so in three dimensions only, for pairs that ask W() and its like, or must not see frozen geometry.
//
// Where pairs seldom change (static bodies, the reference configuration) what depends on them alone is worth keeping:
//     auto store(const auto& p) const { return p.j(volume) * p.grad_W(); }
//     auto pair(const auto& p, const auto& kept) const { return (p.j(f) - p.i(f)) * kept; }
// `store` is evaluated once for each pair of a list, when its row is first met after the list was built, and its
// result is kept beside the list: 8 bytes a pair for each number. It may read only what does not change until then.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "shoal/detail/kept_pairs.hpp"
#include "shoal/detail/row_group.hpp"
#include "shoal/operator.hpp"
#include "shoal/pack.hpp"
#include "shoal/pair.hpp"
#include "shoal/single_precision.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "shoal/vec.hpp"

namespace shoal {

inline namespace SHOAL_ISA_NAMESPACE {
namespace pair_loop {

// Adds the pairs of the lanes that hold a neighbour; the scalar loop has one lane, always full.
template <Real R>
void add_lanes(R& sum, const R& value, typename RealTraits<R>::MaskType lanes) {
  sum = select(lanes, sum + value, sum);
}
template <int D, class R, class M>
void add_lanes(Vec<D, R>& sum, const Vec<D, R>& value, M lanes) {
  for (int k = 0; k < D; ++k) add_lanes(sum[k], value[k], lanes);
}
template <int D, class R, class M>
void add_lanes(Mat<D, R>& sum, const Mat<D, R>& value, M lanes) {
  for (int k = 0; k < D * D; ++k) add_lanes(sum[k], value[k], lanes);
}
template <class... Values, class M>
void add_lanes(Sums<Values...>& sum, const Sums<Values...>& value, M lanes) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (add_lanes(std::get<k>(sum.values), std::get<k>(value.values), lanes), ...);
  }
  (std::index_sequence_for<Values...>{});
}

// Adds the pairs of all lanes.
template <class T>
void add(T& sum, const T& value) {
  sum = sum + value;
}
template <class... Values>
void add(Sums<Values...>& sum, const Sums<Values...>& value) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (add(std::get<k>(sum.values), std::get<k>(value.values)), ...);
  }
  (std::index_sequence_for<Values...>{});
}

// The sums of each lane.
template <class T>
class Lanes {
 public:
  explicit Lanes(const T& sums) { put(sums, values_); }
  auto of(int lane) const { return read<T>(values_ + lane); }

 private:
  template <class V>
  static auto read(const double* place) {
    return LaneReader<V>::get(place);
  }
  alignas(64) double values_[numbers<T> * RealTraits<typename Numbers<T>::Number>::lanes];
};

// A result with the sums over the lanes of its numbers.
template <class T>
struct OverLanes {
  using Type = decltype(horizontal_sum(std::declval<T>()));
  static Type of(const T& sum) { return horizontal_sum(sum); }
};
template <class... Values>
struct OverLanes<Sums<Values...>> {
  using Type = Sums<typename OverLanes<Values>::Type...>;
  static Type of(const Sums<Values...>& sum) {
    return std::apply([](const auto&... value) { return Type{{horizontal_sum(value)...}}; }, sum.values);
  }
};
template <class T>
auto over_lanes(const T& sum) {
  if constexpr (std::is_same_v<typename Numbers<T>::Number, SinglePack>) {
    SinglePack packs[numbers<T>];
    double totals[numbers<T>];
    put(sum, packs);
    horizontal_sums<numbers<T>>(packs, totals);
    return Reader<typename OverLanes<T>::Type>::get(totals);
  } else {
    return OverLanes<T>::of(sum);
  }
}

template <class Op, int D, class Sum>
void finish_particle(const Op& op, Particle<D> i, const Sum& sum) {
  const auto total = over_lanes(sum);
  if constexpr (requires { total.values; })
    std::apply([&](const auto&... value) { op.particle(i, value...); }, total.values);
  else
    op.particle(i, total);
}

}  // namespace pair_loop

template <class Derived>
class PairOperator : public OperatorBase {
 public:
  static constexpr bool pairs = true;

  // Packs of neighbours; what a run uses.
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if constexpr (may_be_single<D>())
      if (self().single) return in_single<D>(chunk);
    with_own_kernel<D>([&](const auto& kernel) {
      if constexpr (side_by_side<D>())
        columns<D>(kernel, chunk);
      else
        rows<D, Pack>(kernel, chunk);
    });
  }
  // One neighbour after the other: the reference for tests.
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    with_own_kernel<D>([&](const auto& kernel) { rows<D, double>(kernel, chunk); });
  }

  // [main] Looks whether records of neighbours must be made anew; before `begin` of the author.
  void before_begin() {
    if constexpr (may_be_single<3>()) {
      stale_.assign(n_relations(), 0);
      with_single([&](SinglePrecision& single) {
        for (std::size_t k = 0; k < n_relations(); ++k)
          stale_[k] = single.records.begin(k, this, position_, volume_field(),
                                           pair_loop::neighbour_fields(self()), n_of_neighbours(k));
      });
    }
  }
  // Whether there are such records.
  bool prepares() const {
    bool is_single = false;
    with_single([&](SinglePrecision&) { is_single = true; });
    return is_single;
  }
  // Makes those of a chunk's share of the neighbours.
  template <int D>
  void prepare_chunk(const shoal_chunk& chunk) const {
    if constexpr (may_be_single<D>())
      for (std::size_t k = 0; k < n_relations(); ++k) {
        if (!stale_[k]) continue;
        const auto share = [&](std::uint64_t i) { return i * n_of_neighbours(k) / n_particles(); };
        self().single->records.template write<D>(k, pair_loop::neighbour_fields(self()), position_,
                                                 volume_field(), position_unit(), smoothing_length(),
                                                 share(chunk.begin), share(chunk.end));
      }
  }

  // W(0), a particle's own part of a sum of W.
  double self_W() const {
    double w = 0;
    const auto evaluate = [&](const auto& kernel) { w = kernel.w(0.0); };
    dimensions() == 2 ? with_own_kernel<2>(evaluate) : with_own_kernel<3>(evaluate);
    return w;
  }

  void bind(const shoal_binding& binding) {
    OperatorBase::bind(binding);
    if constexpr (requires { Derived::skips_lonely; }) find_rows_with_neighbours();
    with_single([&](SinglePrecision& single) {
      for (std::size_t k = 0; k < n_relations(); ++k)
        single.records.make_room(k, n_of_neighbours(k), record_size(), dimensions());
    });
    if (!keeps_pairs()) return;
    kept_.resize(n_relations());
    for (std::size_t k = 0; k < n_relations(); ++k)
      kept_[k].follow(neighbours(k), dimensions() == 2 ? kept_numbers<2>() : kept_numbers<3>());
  }
  // Bytes of a neighbour's records, where they are more than other operators that share them have counted.
  std::uint32_t bytes_per_particle() const {
    std::uint32_t bytes = 0;
    with_single([&](SinglePrecision& single) {
      bytes =
          single.records.count(4 * static_cast<std::uint32_t>((dimensions() == 3 ? 4 : 0) + record_size()));
    });
    return bytes;
  }
  // Bytes that the operator keeps for each pair, in the case's dimensions.
  std::uint32_t bytes_per_pair() const {
    return static_cast<std::uint32_t>(8 * (dimensions() == 2 ? kept_numbers<2>() : kept_numbers<3>()));
  }

 protected:
  PairOperator() : OperatorBase(true) {}

  template <int D, class F>
  decltype(auto) with_own_kernel(F&& f) const {
    if constexpr (requires { typename Derived::template Kernel<D>; })
      return std::forward<F>(f)(typename Derived::template Kernel<D>(smoothing_length()));
    else
      return with_kernel<D>(target().smoothing_kernel, smoothing_length(), std::forward<F>(f));
  }
  const In<Vector>& position() const { return position_; }

 private:
  static constexpr const char* geometry() {
    if constexpr (requires { Derived::pair_geometry; })
      return Derived::pair_geometry;
    else
      return "position";
  }

  template <int D>
  static constexpr bool may_be_single() {
    return (D == 3 || !requires { Derived::single_in_3d_only; }) && requires(const Derived& op) {
      op.single->records;
    };
  }
  // Calls f with what the operator shares, if it runs in single precision.
  template <class F>
  void with_single([[maybe_unused]] const F& f) const {
    if constexpr (may_be_single<3>())
      if (self().single && (may_be_single<2>() || dimensions() == 3)) f(*self().single);
  }
  // The member `volume` if it is read, else nullptr.
  const Field<Scalar, false>* volume_field() const {
    if constexpr (requires(const Derived& op) { static_cast<const Field<Scalar, false>&>(op.volume); })
      return &self().volume;
    else
      return nullptr;
  }
  double position_unit() const { return pair_loop::position_unit(target().cutoff); }
  // Floats of a neighbour, apart from its geometry.
  int record_size() const {
    using Fields = decltype(pair_loop::neighbour_fields(self()));
    return dimensions() == 2 ? pair_loop::LayoutOf<Fields, 2>::type::size
                             : pair_loop::LayoutOf<Fields, 3>::type::size;
  }

  template <class P>
  static constexpr bool stores = requires(const Derived& op, const P& p) {
    op.store(p);
  };
  static constexpr bool keeps_pairs() { return stores<Pair<2, Pack, WendlandC2<2>>>; }
  template <int D>
  static constexpr int kept_numbers() {
    using P = Pair<D, Pack, WendlandC2<D>>;
    if constexpr (stores<P>)
      return pair_loop::numbers<decltype(std::declval<const Derived&>().store(std::declval<const P&>()))>;
    else
      return 0;
  }

  // The value of one pack of pairs, with what is kept of them where the operator keeps something. `entry` is their
  // place in the list.
  template <class P>
  [[gnu::always_inline]] auto value_of(const P& p, [[maybe_unused]] std::size_t k,
                                       [[maybe_unused]] std::uint64_t entry) const {
    if constexpr (stores<P>) {
      using Kept = decltype(self().store(p));
      return self().pair(p, pair_loop::get<Kept>(kept_[k].at(entry, pair_loop::numbers<Kept>)));
    } else {
      return self().pair(p);
    }
  }

  // Not inlined: what is kept must have the same bits in the pass that makes it and in those that load it, so it may
  // not be contracted with what follows.
  template <class R, int D, class Kernel>
  [[gnu::noinline]] void fill_row(const Kernel& kernel, std::size_t k, Particle<D> i) const {
    const shoal_neighbours& list = neighbours(k);
    const std::uint64_t first = list.offsets[i.index];
    const Vec<D> x_i = position_[i];
    const double* x_of_neighbours = position_.of_neighbours(k);
    constexpr auto step = static_cast<std::uint32_t>(RealTraits<R>::lanes);
    for (std::uint32_t m = 0; m < list.counts[i.index]; m += step) {
      const std::uint32_t* entry = list.indices + first + m;
      const auto j = [&] {
        if constexpr (std::is_same_v<R, double>)
          return std::size_t{*entry};
        else
          return IndexPack::load(entry);
      }();
      const Pair<D, R, Kernel> p(kernel, k, i, x_i, x_of_neighbours, j);
      pair_loop::put(self().store(p), kept_[k].at(first + m, kept_numbers<D>()));
    }
  }

  // A function of its own with all pair code inside: left to its heuristics the compiler inlines too much around it, or
  // too little in it, and spills the lanes (measured: half the speed).
  template <int D, class R, class Kernel>
  [[gnu::noinline, gnu::flatten]] void rows(const Kernel& kernel, const shoal_chunk& chunk) const {
    using Result = decltype(value_of(std::declval<const Pair<D, R, Kernel>&>(), 0, 0));
    const auto one = [&](std::uint64_t index) {
      const Particle<D> i{index, chunk.partial};
      Result sum{};
      for (std::size_t k = 0; k < n_relations(); ++k) add_row<R>(kernel, k, i, sum);
      pair_loop::finish_particle(self(), i, sum);
    };
    for_rows(chunk, one);
  }

  // Calls one(i) for the particles of a chunk, but for lonely ones if the operator skips them.
  template <class One>
  void for_rows(const shoal_chunk& chunk, const One& one) const {
    if constexpr (requires { Derived::skips_lonely; }) {
      const auto end = rows_with_neighbours_.end();
      for (auto row = std::lower_bound(rows_with_neighbours_.begin(), end, chunk.begin);
           row != end && *row < chunk.end; ++row)
        one(*row);
    } else {
      for (std::uint64_t index = chunk.begin; index < chunk.end; ++index) one(index);
    }
  }

  // Whether rows are read side by side: in 2D, where they are short (some twenty neighbours: a fifth less time, a third
  // less for the many sums of a fit); the long rows of 3D are read faster one after another (by a tenth).
  template <int D>
  static constexpr bool side_by_side() {
    return D == 2 && !keeps_pairs() && !requires { Derived::row_by_row; };
  }

  // `lanes` rows side by side: each lane adds up the pairs of a particle of its own, one after the other. Nothing has to be
  // summed over lanes, and rows that are shorter than a pack, or a little longer, leave few lanes empty.
  template <int D, class Kernel>
  [[gnu::noinline, gnu::flatten]] void columns(const Kernel& kernel, const shoal_chunk& chunk) const {
    constexpr bool consecutive = !requires { Derived::skips_lonely; };
    using Own = ParticlePack<D, consecutive>;
    using Result = decltype(self().pair(std::declval<const Pair<D, Pack, Kernel, Own>&>()));
    alignas(64) std::uint32_t index[lanes];
    const auto group = [&](int n) {
      Result sum{};
      for (std::size_t k = 0; k < n_relations(); ++k) add_columns<D>(kernel, k, Own{index}, n, sum);
      const pair_loop::Lanes<Result> sums(sum);
      for (int lane = 0; lane < n; ++lane)
        pair_loop::finish_particle(self(), Particle<D>{index[lane], chunk.partial}, sums.of(lane));
    };
    if constexpr (consecutive) {
      for (std::uint64_t first = chunk.begin; first < chunk.end; first += lanes) {
        for (int lane = 0; lane < lanes; ++lane)
          index[lane] = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(lane);
        group(static_cast<int>(std::min<std::uint64_t>(lanes, chunk.end - first)));
      }
    } else {
      const auto end = rows_with_neighbours_.end();
      for (auto row = std::lower_bound(rows_with_neighbours_.begin(), end, chunk.begin);
           row != end && *row < chunk.end;) {
        int n = 0;
        for (; n < lanes && row != end && *row < chunk.end; ++n) index[n] = *row++;
        for (int lane = n; lane < lanes; ++lane) index[lane] = index[n - 1];
        group(n);
      }
    }
  }

  template <int D>
  void in_single(const shoal_chunk& chunk) const {
    if constexpr (D == 2)
      frozen_columns<D>(chunk);
    else
      with_kernel<D>(target().smoothing_kernel, 1.0,
                     [&](const auto& unit_kernel) { single_rows<D>(unit_kernel, chunk); });
  }

  // Rows one after the other, in single precision.
  template <int D, class Kernel>
  [[gnu::noinline, gnu::flatten]] void single_rows(const Kernel& unit_kernel,
                                                   const shoal_chunk& chunk) const {
    const auto fields = pair_loop::neighbour_fields(self());
    using View = pair_loop::RecordView<D, std::remove_const_t<decltype(fields)>>;
    using P = SinglePair<D, Kernel, View>;
    using Result = decltype(self().pair(std::declval<const P&>()));
    const SingleRecords& records = self().single->records;
    const typename P::Scales scales{position_unit(), smoothing_length(), volume_field()};
    const double per_volume = detail::per_volume<D>(scales.h), per_unit = 1.0 / scales.unit;
    // Then the particle has a record itself, as long as it is among those that they were made for.
    const bool among_neighbours = position_.of_neighbours(0) == position_.data();
    for_rows(chunk, [&](std::uint64_t index) {
      const Particle<D> particle{index, chunk.partial};
      typename P::Own i;
      if (among_neighbours) {
        i.read(records.template view<D>(0, fields), particle);
      } else {
        i.read(fields, particle);
        for (int a = 0; a < D; ++a)
          i.geometry[a] = SinglePack::from_raw(
              simd::single::broadcast(pair_loop::whole_number(position_[particle][a], per_unit)));
        // Where volumes are read of neighbours only (walls), or not at all, nobody asks for weights of both.
        const bool known = scales.volume != nullptr && scales.volume->data() != nullptr;
        i.geometry[3] = known ? (*scales.volume)[particle] * per_volume : 0.0;
      }
      i.volume = (D == 2 ? 1.0 : scales.h) * i.geometry[3];
      Result sum{};
      for (std::size_t k = 0; k < n_relations(); ++k) {
        const View view = records.template view<D>(k, fields);
        const shoal_neighbours& list = neighbours(k);
        const std::uint32_t n = list.counts[index];
        const std::uint32_t* row = list.indices + list.offsets[index];
        // Rows are padded for a pack, not for a single pack: its upper lanes read the last ones again then.
        const std::uint32_t last = (n + lanes - 1) / lanes * lanes - lanes;
        const auto pack_at = [&](std::uint32_t m) {
          return SingleIndexPack{row + m, row + std::min<std::uint32_t>(m + lanes, last)};
        };
        constexpr std::uint32_t at_a_time = 8;
        for (std::uint32_t first = 0; first < n; first += at_a_time * single_lanes) {
          typename P::Geometry geometry[at_a_time];
          const std::uint32_t end = std::min(n, first + at_a_time * single_lanes);
          for (std::uint32_t m = first, c = 0; m < end; m += single_lanes, ++c)
            geometry[c] = typename P::Geometry(view, scales, i, pack_at(m));
          for (std::uint32_t m = first, c = 0; m < end; m += single_lanes, ++c)
            pair_loop::add_lanes(sum, self().pair(P(unit_kernel, view, scales, i, pack_at(m), geometry[c])),
                                 first_single_lanes(n - m));
        }
      }
      pair_loop::finish_particle(self(), particle, sum);
    });
  }

  // The same with what FreezeGeometry has written, side by side.
  template <int D>
  [[gnu::noinline, gnu::flatten]] void frozen_columns(const shoal_chunk& chunk) const {
    FrozenGeometry& geometry = self().single->frozen;
    const SingleRecords& records = self().single->records;
    const auto fields = pair_loop::neighbour_fields(self());
    using View = pair_loop::RecordView<D, std::remove_const_t<decltype(fields)>>;
    using P = FrozenPair<D, View>;
    using Result = decltype(self().pair(std::declval<const P&>()));
    const double h = smoothing_length();
    const std::uint64_t end = geometry.first_group(chunk.end);
    for (std::uint64_t group = geometry.first_group(chunk.begin); group < end; ++group) {
      const std::uint64_t first = group * single_lanes;
      const int n = geometry.rows_in(group);
      typename P::Own i;
      i.read(fields, {first, n > lanes ? first + lanes : first});
      Result sum{};
      for (std::size_t k = 0; k < n_relations(); ++k) {
        const View view = records.template view<D>(k, fields);
        FrozenGeometry::Column column = geometry.columns(k, group);
        for (std::uint64_t m = geometry.n_columns(k, group); m > 0; --m, column.advance(D))
          pair_loop::add(sum, self().pair(P(h, view, i, column.neighbours, column.numbers)));
      }
      const pair_loop::Lanes<Result> sums(sum);
      for (int lane = 0; lane < n; ++lane)
        pair_loop::finish_particle(
            self(), Particle<D>{first + static_cast<std::uint64_t>(lane), chunk.partial}, sums.of(lane));
    }
  }

  template <int D, class Kernel, class Own, class Sum>
  void add_columns(const Kernel& kernel, std::size_t k, const Own& i, int n, Sum& sum) const {
    pair_loop::RowGroup rows(neighbours(k), i.index, n);
    if (rows.longest() == 0) return;
    Vec<D, Pack> x_i;
    i.template read<D>(position_.data(), x_i.e);
    const double* x_of_neighbours = position_.of_neighbours(k);
    for (std::uint32_t m = 0; m < rows.longest(); m += lanes) {
      rows.transpose(m);
      const std::uint32_t last = std::min<std::uint32_t>(lanes, rows.longest() - m);
      for (std::uint32_t c = 0; c < last; ++c) {
        const Pair<D, Pack, Kernel, Own> p(kernel, k, i, x_i, x_of_neighbours, rows.column(c));
        pair_loop::add_lanes(sum, self().pair(p), rows.lanes_longer_than(m + c));
      }
    }
  }

  template <class R, int D, class Kernel, class Sum>
  void add_row(const Kernel& kernel, std::size_t k, Particle<D> i, Sum& sum) const {
    const shoal_neighbours& list = neighbours(k);
    const std::uint32_t n = list.counts[i.index];
    const std::uint32_t* row = list.indices + list.offsets[i.index];
    const Vec<D> x_i = position_[i];
    const double* x_of_neighbours = position_.of_neighbours(k);
    const std::uint64_t first = list.offsets[i.index];
    if constexpr (keeps_pairs())
      if (kept_[k].begin_row(i.index, RealTraits<R>::lanes)) fill_row<R>(kernel, k, i);
    if constexpr (std::is_same_v<R, double>) {
      for (std::uint32_t m = 0; m < n; ++m) {
        const Pair<D, R, Kernel> p(kernel, k, i, x_i, x_of_neighbours, row[m]);
        pair_loop::add_lanes(sum, value_of(p, k, first + m), true);
      }
    } else {
      for (std::uint32_t m = 0; m < n; m += lanes) {
        const Pair<D, R, Kernel> p(kernel, k, i, x_i, x_of_neighbours, IndexPack::load(row + m));
        pair_loop::add_lanes(sum, value_of(p, k, first + m), first_lanes(n - m));
      }
    }
  }

  // Looked up once for each list: asking each row in each pass costs more than the pairs of the few that have some.
  void find_rows_with_neighbours() {
    rows_with_neighbours_.clear();
    std::uint64_t n_rows = n_particles();  // fewer where particles have joined since the lists were built
    for (std::size_t k = 0; k < n_relations(); ++k) n_rows = std::min(n_rows, neighbours(k).n_rows);
    for (std::uint64_t i = 0; i < n_rows; ++i) {
      std::uint32_t n = 0;
      for (std::size_t k = 0; k < n_relations(); ++k) n |= neighbours(k).counts[i];
      if (n != 0) rows_with_neighbours_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  const Derived& self() const { return static_cast<const Derived&>(*this); }

  In<Vector> position_{geometry()};
  std::vector<std::uint32_t> rows_with_neighbours_;  // of operators that skip lonely particles
  std::vector<char> stale_;                          // [relation] records that must be made anew
  mutable std::vector<pair_loop::KeptPairs>
      kept_;  // [relation]; rows are written by the thread that runs them
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
