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
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "shoal/operator.hpp"
#include "shoal/pack.hpp"
#include "shoal/smoothing_kernel.hpp"
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

template <class Op, int D, class Sum>
void finish_particle(const Op& op, Particle<D> i, const Sum& sum) {
  op.particle(i, horizontal_sum(sum));
}
template <class Op, int D, class... Values>
void finish_particle(const Op& op, Particle<D> i, const Sums<Values...>& sum) {
  std::apply([&](const auto&... value) { op.particle(i, horizontal_sum(value)...); }, sum.values);
}

}  // namespace pair_loop

// One particle i and `lanes` of its neighbours j (R = Pack), or one neighbour (R = double).
template <int D, class R, class Kernel>
class Pair {
 public:
  static constexpr int dimensions = D;
  using RealType = R;
  using Indices = typename RealTraits<R>::IndexType;

  Pair(const Kernel& kernel, std::size_t relation, Particle<D> i, const Vec<D>& x_i,
       const double* x_of_neighbours, Indices j)
      : kernel_(kernel), relation_(relation), i_(i), j_(j), r_ij_(x_i - gather_vec<D>(x_of_neighbours, j)) {
    // Coincident particles have no direction: the limit makes e = 0 there, not NaN.
    r_ = sqrt(max(R(1e-200), squared_norm(r_ij_)));
  }

  // Distance |r_i - r_j| in m.
  R r() const { return r_; }
  // r_i - r_j in m.
  const Vec<D, R>& r_ij() const { return r_ij_; }
  // Unit vector from j to i.
  Vec<D, R> e() const { return (R(1.0) / r_) * r_ij_; }
  // Smoothing kernel in 1/m^D, its derivative dW/dr <= 0, (dW/dr)/r, and its gradient with respect to r_i.
  R W() const { return kernel_.w(r_); }
  R dW() const { return kernel_.dw(r_); }
  R dW_over_r() const { return kernel_.dw_over_r(r_); }
  Vec<D, R> grad_W() const { return dW_over_r() * r_ij_; }
  // Smoothing length in m.
  double h() const { return kernel_.h(); }

  // The particle's own value of a field.
  template <class T, bool Writable>
  auto i(const Field<T, Writable>& field) const {
    return field[i_];
  }
  // The neighbours' values of a field.
  template <bool Writable>
  R j(const Field<Scalar, Writable>& field) const {
    return gather<1, 0>(field.of_neighbours(relation_), j_);
  }
  template <bool Writable>
  Vec<D, R> j(const Field<Vector, Writable>& field) const {
    return gather_vec<D>(field.of_neighbours(relation_), j_);
  }
  template <bool Writable>
  Mat<D, R> j(const Field<Matrix, Writable>& field) const {
    return gather_mat<D>(field.of_neighbours(relation_), j_);
  }

 private:
  const Kernel& kernel_;
  std::size_t relation_;
  Particle<D> i_;
  Indices j_;
  Vec<D, R> r_ij_;
  R r_;
};

template <class Derived>
class PairOperator : public OperatorBase {
 public:
  static constexpr bool pairs = true;

  // Packs of neighbours; what a run uses.
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    with_kernel<D>(target().smoothing_kernel, smoothing_length(),
                   [&](const auto& kernel) { rows<D, Pack>(kernel, chunk); });
  }
  // One neighbour after the other: the reference for tests.
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    with_kernel<D>(target().smoothing_kernel, smoothing_length(),
                   [&](const auto& kernel) { rows<D, double>(kernel, chunk); });
  }

  // W(0), a particle's own part of a sum of W.
  double self_W() const {
    double w = 0;
    const auto evaluate = [&](const auto& kernel) { w = kernel.w(0.0); };
    dimensions() == 2 ? with_kernel<2>(target().smoothing_kernel, smoothing_length(), evaluate)
                      : with_kernel<3>(target().smoothing_kernel, smoothing_length(), evaluate);
    return w;
  }

 protected:
  PairOperator() : OperatorBase(true) {}

 private:
  template <int D, class R, class Kernel>
  void rows(const Kernel& kernel, const shoal_chunk& chunk) const {
    using Result = decltype(self().pair(std::declval<const Pair<D, R, Kernel>&>()));
    for (std::uint64_t index = chunk.begin; index < chunk.end; ++index) {
      if constexpr (requires { Derived::skips_lonely; })
        if (is_lonely(index)) continue;
      const Particle<D> i{index, chunk.partial};
      Result sum{};
      for (std::size_t k = 0; k < n_relations(); ++k) add_row<R>(kernel, k, i, sum);
      pair_loop::finish_particle(self(), i, sum);
    }
  }

  template <class R, int D, class Kernel, class Sum>
  void add_row(const Kernel& kernel, std::size_t k, Particle<D> i, Sum& sum) const {
    const shoal_neighbours& list = neighbours(k);
    const std::uint32_t n = list.counts[i.index];
    const std::uint32_t* row = list.indices + list.offsets[i.index];
    const Vec<D> x_i = position_[i];
    const double* x_of_neighbours = position_.of_neighbours(k);
    if constexpr (std::is_same_v<R, double>) {
      for (std::uint32_t m = 0; m < n; ++m)
        pair_loop::add_lanes(sum, self().pair(Pair<D, R, Kernel>(kernel, k, i, x_i, x_of_neighbours, row[m])),
                             true);
    } else {
      for (std::uint32_t m = 0; m < n; m += lanes) {
        const Pair<D, R, Kernel> p(kernel, k, i, x_i, x_of_neighbours, IndexPack::load(row + m));
        pair_loop::add_lanes(sum, self().pair(p), first_lanes(static_cast<std::int64_t>(n) - m));
      }
    }
  }

  bool is_lonely(std::uint64_t i) const {
    for (std::size_t k = 0; k < n_relations(); ++k)
      if (neighbours(k).counts[i] != 0) return false;
    return true;
  }

  const Derived& self() const { return static_cast<const Derived&>(*this); }

  In<Vector> position_{"position"};
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
