// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What an operator in single precision reads of its neighbours (single_precision.hpp), made anew for a pass if it has
// changed: records of four numbers, which are read in one piece and transposed.
//
//     geometry   position, volume / h^D; in 2D that of FrozenGeometry is read instead
//     fields     those of Derived::neighbour_fields(), one behind the other; none stands in two records if it fits in one;
//                records that hold zeros only (velocities of walls at rest) are not read
//
// Positions are whole numbers modulo 2^32 of a unit that is a small part of the cut-off: differences are exact, so their
// error is the same everywhere in a domain of any size. A NaN or an infinity among the coordinates makes the volume NaN.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "shoal/operator.hpp"
#include "shoal/single_pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {
namespace pair_loop {

// Numbers of a field that holds T.
template <class T, int D>
inline constexpr int field_numbers = std::is_same_v<T, Scalar>   ? 1
                                     : std::is_same_v<T, Vector> ? D
                                     : std::is_same_v<T, Matrix>
                                         ? D* D
                                         : static_cast<int>(D == 2 ? impl::array_size<T>.in_2d
                                                                   : impl::array_size<T>.in_3d);

// Whole numbers for coordinates; `unit` is a power of two, so that dividing by it is exact.
inline double position_unit(double cutoff) {
  return std::exp2(std::ceil(std::log2(cutoff)) - 26);  // differences of up to 32 cut-offs are told apart
}
inline float whole_number(double x, double per_unit) {
  // The mantissa of a number of this size ends with its whole part, in two's complement.
  const double shifted = x * per_unit + 0x1.8p52;
  return std::bit_cast<float>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(shifted)));
}

// Where the fields stand. `Fields` are those of a tuple of references.
template <int D, class... Fields>
struct RecordLayout {
  static constexpr int n = sizeof...(Fields);
  static constexpr std::array<int, n + 1> places = [] {  // the last is the end
    constexpr std::array<int, n + 1> numbers = {field_numbers<typename Fields::value_tag, D>..., 0};
    std::array<int, n + 1> at{};
    int next = 0;
    for (std::size_t k = 0; k <= n; ++k) {
      if (next % 4 + numbers[k] > 4 || k == n) next = (next + 3) / 4 * 4;
      at[k] = next;
      next += numbers[k];
    }
    return at;
  }();
  static constexpr int size = places[n];  // floats of a particle
};

template <class Tuple, int D>
struct LayoutOf;
template <class... Fields, int D>
struct LayoutOf<std::tuple<const Fields&...>, D> {
  using type = RecordLayout<D, Fields...>;
};

// The fields that an operator lists.
template <class Op>
auto neighbour_fields(const Op& op) {
  if constexpr (requires { op.neighbour_fields(); })
    return op.neighbour_fields();
  else
    return std::tuple<>{};
}

// The records of one relation, as pairs read them.
template <int D, class Fields>
class RecordView {
 public:
  using Layout = typename LayoutOf<Fields, D>::type;

  RecordView(const Fields& fields, std::size_t relation, const float* geometry, const float* records,
             const char* in_use)
      : fields_(fields), relation_(relation), geometry_(geometry), records_(records), in_use_(in_use) {}

  std::size_t relation() const { return relation_; }
  // x, y, z as whole numbers, and the volume over h^D.
  void gather_geometry(SingleIndexPack j, SinglePack* out) const { gather_four<4>(geometry_, j, out); }

  // The N numbers of a field of each neighbour; of one that is not listed, from where the kernel holds it.
  template <int N, class F>
  void gather(const F& field, SingleIndexPack j, SinglePack* out) const {
    if (!find<N>(field, [&](auto place) { load<N, place>(j, out); }))
      gather_tuple<N>(field.of_neighbours(relation_), j, out);
  }

  // Calls found(place) if the field is listed. Which it is follows from the addresses of two members, which the compiler
  // knows.
  template <int N, class F, class Found>
  bool find(const F& field, const Found& found) const {
    return [&]<std::size_t... k>(std::index_sequence<k...>) {
      return (... || ([&] {
                if (static_cast<const void*>(&std::get<k>(fields_)) != static_cast<const void*>(&field))
                  return false;
                if constexpr (Layout::places[k] + N <= Layout::size)
                  found(std::integral_constant<int, Layout::places[k]>{});
                return true;
              }()));
    }
    (std::make_index_sequence<Layout::n>{});
  }

  // The numbers of one record, in all lanes.
  void own_geometry(std::size_t i, SinglePack* out) const { spread<4>(geometry_ + 4 * i, out); }
  void own(std::size_t i, SinglePack* out) const { spread<Layout::size>(records_ + Layout::size * i, out); }

 private:
  template <int N>
  static void spread(const float* record, SinglePack* out) {
    for (int k = 0; k < N; ++k) out[k] = SinglePack::from_raw(simd::single::broadcast(record[k]));
  }

  template <int N, int Place>
  void load(SingleIndexPack j, SinglePack* out) const {
    SinglePack record[4];
    for (int m = 0; m < N; m += 4) {
      if (in_use_[Place / 4 + m / 4] != 0)
        gather_four<Layout::size>(records_ + Place / 4 * 4 + m, j, record);
      else
        std::fill_n(record, 4, SinglePack(0.0));
      for (int c = 0; c < 4 && m + c < N; ++c) out[m + c] = record[Place % 4 + c];
    }
  }

  const Fields& fields_;
  std::size_t relation_;
  const float *geometry_, *records_;
  const char* in_use_;  // [record] whether it is more than zeros
};

// The N own numbers of a field: of one particle the same in each lane.
template <int N, class F, class Own>
void read_own(const F& field, const Own& i, SinglePack* out) {
  if constexpr (requires { i.template read<N>(field.data(), out); })
    i.template read<N>(field.data(), out);
  else
    for (int c = 0; c < N; ++c) out[c] = field.data()[i.index * N + static_cast<std::uint64_t>(c)];
}

// The own values of listed fields of a particle, or of those in the lanes: read once for all their pairs.
template <class View, class Own>
struct OwnRecord {
  Own i;
  SinglePack values[std::max(View::Layout::size, 1)];

  template <class Fields>
  void read(const Fields& fields, Own own) {
    i = own;
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (read_field<View::Layout::places[k]>(std::get<k>(fields)), ...);
    }
    (std::make_index_sequence<View::Layout::n>{});
  }
  // The same from the record that the particle has as a neighbour of others.
  void read(const View& view, Own own) {
    i = own;
    view.own(own.index, values);
  }

 private:
  template <int Place, class T, bool Writable>
  void read_field(const Field<T, Writable>& field) {
    read_own<field_numbers<T, Own::dimensions>>(field, i, values + Place);
  }
};

}  // namespace pair_loop

// The records' memory; operators that run one after the other share it.
class SingleRecords {
 public:
  // [main] Room for the records of as many particles of a relation.
  void make_room(std::size_t relation, std::uint64_t n_particles, int floats_per_particle, int dimensions) {
    if (relations_.size() <= relation) relations_.resize(relation + 1);
    if (dimensions == 3) grow(relations_[relation].geometry, n_particles * 4);
    grow(relations_[relation].fields, n_particles * static_cast<std::uint64_t>(floats_per_particle));
    std::vector<char>& in_use = relations_[relation].in_use;
    in_use.resize(std::max(in_use.size(), static_cast<std::size_t>(floats_per_particle / 4)));
  }

  // [main] Of so many bytes a particle, those that go beyond what has been counted so far.
  std::uint32_t count(std::uint32_t bytes) {
    const std::uint32_t counted = std::exchange(counted_, std::max(counted_, bytes));
    return counted_ - counted;
  }

  // [main] Whether the records of a relation must be written: they are others' than `owner`'s, or what they hold has
  // changed. The owner is an operator and its fields in the order of neighbour_fields().
  template <class Fields>
  bool begin(std::size_t relation, const void* owner, const Field<Vector, false>& position,
             const Field<Scalar, false>* volume, const Fields& fields, std::uint64_t n_particles) {
    std::vector<std::uint64_t> held = {reinterpret_cast<std::uintptr_t>(owner), n_particles};
    bool counted = true;
    const auto add = [&](const auto& field) {
      const std::uint64_t* changes = field.changes_of_neighbours(relation);
      counted = counted && changes != nullptr;
      held.push_back(reinterpret_cast<std::uintptr_t>(field.of_neighbours(relation)));
      held.push_back(changes != nullptr ? *changes : 0);
    };
    add(position);
    if (volume != nullptr) add(*volume);
    std::apply([&](const auto&... field) { (add(field), ...); }, fields);
    const bool stale = !counted || held != relations_[relation].held;
    relations_[relation].held = std::move(held);
    if (stale) std::fill(relations_[relation].in_use.begin(), relations_[relation].in_use.end(), 0);
    return stale;
  }

  // [worker] Writes the records of the particles begin ... end - 1.
  template <int D, class Fields>
  void write(std::size_t relation, const Fields& fields, const Field<Vector, false>& position,
             const Field<Scalar, false>* volume, double unit, double h, std::uint64_t begin,
             std::uint64_t end) {
    using Layout = typename pair_loop::LayoutOf<Fields, D>::type;
    if constexpr (D == 3) write_geometry(relation, position, volume, unit, h, begin, end);
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (write_field<D, Layout::places[k], Layout::size>(std::get<k>(fields), relation, begin, end), ...);
    }
    (std::make_index_sequence<Layout::n>{});
  }

  template <int D, class Fields>
  pair_loop::RecordView<D, Fields> view(std::size_t relation, const Fields& fields) const {
    const Relation& r = relations_[relation];
    return {fields, relation, r.geometry.data(), r.fields.data(), r.in_use.data()};
  }

 private:
  struct Relation {
    std::vector<float> geometry, fields;
    std::vector<char> in_use;  // [record of the fields]
    std::vector<std::uint64_t> held;
  };

  // Numbers of particles change from step to step, where there are images.
  static void grow(std::vector<float>& numbers, std::uint64_t size) {
    if (numbers.size() < size) numbers.resize(size + size / 16);
  }

  void write_geometry(std::size_t relation, const Field<Vector, false>& position,
                      const Field<Scalar, false>* volume, double unit, double h, std::uint64_t begin,
                      std::uint64_t end) {
    const double per_unit = 1.0 / unit, per_volume = detail::per_volume<3>(h);
    const double *x = position.of_neighbours(relation),
                 *v = volume != nullptr ? volume->of_neighbours(relation) : nullptr;
    float* geometry = relations_[relation].geometry.data();
    for (std::uint64_t j = begin; j < end; ++j) {
      double nothing = 0.0;
      for (std::uint64_t a = 0; a < 3; ++a) {
        geometry[4 * j + a] = pair_loop::whole_number(x[3 * j + a], per_unit);
        nothing += 0.0 * x[3 * j + a];
      }
      geometry[4 * j + 3] = static_cast<float>((v != nullptr ? v[j] * per_volume : 1.0) + nothing);
    }
  }

  template <int D, int Place, int Size, class F>
  void write_field(const F& field, std::size_t relation, std::uint64_t begin, std::uint64_t end) {
    constexpr auto n = static_cast<std::size_t>(pair_loop::field_numbers<typename F::value_tag, D>);
    const double* from = field.of_neighbours(relation);
    float* to = relations_[relation].fields.data() + Place;
    for (std::uint64_t j = begin; j < end; ++j)
      for (std::size_t c = 0; c < n; ++c) to[j * Size + c] = static_cast<float>(from[j * n + c]);
    for (std::size_t m = 0; m < n; m += 4) {
      const std::atomic_ref<char> in_use(relations_[relation].in_use[Place / 4 + m / 4]);
      if (in_use.load(std::memory_order_relaxed) != 0) continue;
      bool zeros = true;
      for (std::uint64_t j = begin; j < end && zeros; ++j)
        for (std::size_t c = m; c < std::min(n, m + 4); ++c) zeros = zeros && to[j * Size + c] == 0.0F;
      if (!zeros) in_use.store(1, std::memory_order_relaxed);
    }
  }

  std::vector<Relation> relations_;
  std::uint32_t counted_ = 0;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
