// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Results of pair code (a number, a Vec, a Mat, or sums of these) as rows of numbers, and numbers kept beside the
// entries of a neighbour list. A pack of entries keeps all its first numbers, then all its second ones, and so on.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "shoal/abi.h"
#include "shoal/pack.hpp"
#include "shoal/vec.hpp"

namespace shoal {

// Several sums over the same neighbours, gathered in one pass.
template <class... Values>
struct Sums {
  std::tuple<Values...> values;
};
template <class... Values>
Sums<Values...> sums(Values... values) {
  return {{values...}};
}

inline namespace SHOAL_ISA_NAMESPACE {
namespace pair_loop {

template <class T>
struct Numbers {
  using Number = T;
  static constexpr int count = 1;
};
template <int D, class R>
struct Numbers<Vec<D, R>> {
  using Number = R;
  static constexpr int count = D;
};
template <int D, class R>
struct Numbers<Mat<D, R>> {
  using Number = R;
  static constexpr int count = D * D;
};
template <class First, class... Others>
struct Numbers<Sums<First, Others...>> {
  using Number = typename Numbers<First>::Number;
  static constexpr int count = Numbers<First>::count + (0 + ... + Numbers<Others>::count);
};

// How many numbers a result has.
template <class T>
inline constexpr int numbers = Numbers<T>::count;

// Writes a result at `place`, or reads it there.
inline void put(double value, double* place) { *place = value; }
inline void put(const Pack& value, double* place) { value.store(place); }
inline void put(const SinglePack& value, double* place) {
  value.low().store(place);
  value.high().store(place + lanes);
}
inline void put(const SinglePack& value, SinglePack* place) { *place = value; }
template <class T, class Place>
requires(std::is_class_v<T> && !detail::is_pack<T>) void put(const T& value, Place* place) {
  constexpr int width = std::is_same_v<Place, double> ? RealTraits<typename Numbers<T>::Number>::lanes : 1;
  if constexpr (requires { value.values; })
    std::apply(
        [&](const auto&... part) {
          ((put(part, place), place += width * numbers<std::decay_t<decltype(part)>>), ...);
        },
        value.values);
  else
    for (int k = 0; k < numbers<T>; ++k) put(value[k], place + k * width);
}

template <class T>
struct Reader {
  static T get(const double* place) {
    if constexpr (std::is_same_v<T, double>) {
      return *place;
    } else if constexpr (std::is_same_v<T, Pack>) {
      return Pack::load(place);
    } else {
      using Number = typename Numbers<T>::Number;
      T value;
      for (int k = 0; k < numbers<T>; ++k)
        value[k] = Reader<Number>::get(place + k * RealTraits<Number>::lanes);
      return value;
    }
  }
};
template <class... Values>
struct Reader<Sums<Values...>> {
  static Sums<Values...> get(const double* place) {
    constexpr int width = RealTraits<typename Numbers<Sums<Values...>>::Number>::lanes;
    const auto next = [&]<class V>(std::type_identity<V>) {
      const V value = Reader<V>::get(place);
      place += width * numbers<V>;
      return value;
    };
    return {std::tuple<Values...>{next(std::type_identity<Values>{})...}};  // in order, as braces demand
  }
};
// One lane of what `put` wrote of packs, at `place` of that lane.
template <class T>
struct LaneReader {
  static double get(const double* place) { return *place; }
};
template <int D, class R>
struct LaneReader<Vec<D, R>> {
  static Vec<D> get(const double* place) {
    Vec<D> value;
    for (int k = 0; k < D; ++k) value[k] = place[k * RealTraits<R>::lanes];
    return value;
  }
};
template <int D, class R>
struct LaneReader<Mat<D, R>> {
  static Mat<D> get(const double* place) {
    Mat<D> value;
    for (int k = 0; k < D * D; ++k) value[k] = place[k * RealTraits<R>::lanes];
    return value;
  }
};
template <class... Values>
struct LaneReader<Sums<Values...>> {
  static auto get(const double* place) {
    const auto next = [&]<class V>(std::type_identity<V>) {
      const auto value = LaneReader<V>::get(place);
      place += RealTraits<typename Numbers<V>::Number>::lanes * numbers<V>;
      return value;
    };
    using Result = Sums<decltype(LaneReader<Values>::get(place))...>;
    return Result{std::tuple{next(std::type_identity<Values>{})...}};  // in order, as braces demand
  }
};

template <class T>
T get(const double* place) {
  return Reader<T>::get(place);
}

// Numbers beside the entries of one list. Rows are filled when they are first met.
class KeptPairs {
 public:
  // [main] Forgets what it keeps if the list is another one than before.
  void follow(const shoal_neighbours& list, int n_numbers) {
    if (followed_ && generation_ == list.generation && row_state_.size() == list.n_rows) return;
    followed_ = true;
    generation_ = list.generation;
    row_state_.assign(list.n_rows, 0);
    std::uint64_t n_entries = 0;
    if (list.n_rows > 0) {
      const std::uint64_t padded =
          (std::uint64_t{list.counts[list.n_rows - 1]} + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
      n_entries = list.offsets[list.n_rows - 1] + padded;
    }
    values_.assign(n_entries * static_cast<std::uint64_t>(n_numbers), 0.0);
  }

  // [worker] Whether the row's numbers must be made: packs of another width (the scalar loop of tests) lie elsewhere.
  bool begin_row(std::uint64_t row, int width) {
    const auto state = static_cast<std::uint8_t>(width);
    if (row_state_[row] == state) return false;
    row_state_[row] = state;
    return true;
  }
  double* at(std::uint64_t entry, int n_numbers) {
    return values_.data() + entry * static_cast<std::uint64_t>(n_numbers);
  }

 private:
  bool followed_ = false;
  std::uint64_t generation_ = 0;
  std::vector<std::uint8_t> row_state_;
  std::vector<double> values_;
};

}  // namespace pair_loop
}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
