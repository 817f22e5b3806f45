// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Vec and Mat: small vectors and matrices for pair code, over double, Pack or SinglePack.
//
// Plain structs, because Eigen inside a pair loop stops vectorisation (measured: three times slower). For the
// algebra of single particles (eigenvalues, decompositions) use Eigen through shoal/eigen.hpp.
// Mixed operands promote: Vec<3> + Vec<3, Pack> is a Vec<3, Pack>.
#pragma once

#include <type_traits>

#include "shoal/pack.hpp"
#include "shoal/single_pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

/// D numbers. An aggregate: Vec<2>{x, y}; Vec<2>{} is zero.
template <int D, class R = double>
struct Vec {
  R e[D];

  constexpr R& operator[](int k) { return e[k]; }
  constexpr const R& operator[](int k) const { return e[k]; }

  template <class S>
  constexpr Vec& operator+=(const Vec<D, S>& b) {
    for (int k = 0; k < D; ++k) e[k] += b.e[k];
    return *this;
  }
  template <class S>
  constexpr Vec& operator-=(const Vec<D, S>& b) {
    for (int k = 0; k < D; ++k) e[k] -= b.e[k];
    return *this;
  }
  constexpr Vec& operator*=(R s) {
    for (int k = 0; k < D; ++k) e[k] *= s;
    return *this;
  }
  constexpr Vec& operator/=(R s) {
    for (int k = 0; k < D; ++k) e[k] /= s;
    return *this;
  }
};

/// D x D numbers, row by row, as in the matrix fields of the kernel. Mat<2>{xx, xy, yx, yy}; Mat<2>{} is zero.
template <int D, class R = double>
struct Mat {
  R e[D * D];

  constexpr R& operator()(int row, int column) { return e[row * D + column]; }
  constexpr const R& operator()(int row, int column) const { return e[row * D + column]; }
  constexpr R& operator[](int k) { return e[k]; }
  constexpr const R& operator[](int k) const { return e[k]; }

  template <class S>
  constexpr Mat& operator+=(const Mat<D, S>& b) {
    for (int k = 0; k < D * D; ++k) e[k] += b.e[k];
    return *this;
  }
  template <class S>
  constexpr Mat& operator-=(const Mat<D, S>& b) {
    for (int k = 0; k < D * D; ++k) e[k] -= b.e[k];
    return *this;
  }
  constexpr Mat& operator*=(R s) {
    for (int k = 0; k < D * D; ++k) e[k] *= s;
    return *this;
  }
  constexpr Mat& operator/=(R s) {
    for (int k = 0; k < D * D; ++k) e[k] /= s;
    return *this;
  }
};

namespace detail {
template <class S>
inline constexpr bool is_pack = std::is_same_v<S, Pack> || std::is_same_v<S, SinglePack>;

template <class A, class B>
using Promoted = std::conditional_t<is_pack<A>, A, std::conditional_t<is_pack<B>, B, double>>;

template <class S>
concept Scalar = std::is_arithmetic_v<S> || is_pack<S>;

template <class S>
using RealOf = std::conditional_t<std::is_arithmetic_v<S>, double, S>;
}  // namespace detail

// Vectors ------------------------------------------------------------------------------------------------------

template <int D, class R>
constexpr Vec<D, R> operator-(const Vec<D, R>& a) {
  Vec<D, R> r{};
  for (int k = 0; k < D; ++k) r.e[k] = -a.e[k];
  return r;
}
template <int D, class A, class B>
constexpr Vec<D, detail::Promoted<A, B>> operator+(const Vec<D, A>& a, const Vec<D, B>& b) {
  Vec<D, detail::Promoted<A, B>> r{};
  for (int k = 0; k < D; ++k) r.e[k] = a.e[k] + b.e[k];
  return r;
}
template <int D, class A, class B>
constexpr Vec<D, detail::Promoted<A, B>> operator-(const Vec<D, A>& a, const Vec<D, B>& b) {
  Vec<D, detail::Promoted<A, B>> r{};
  for (int k = 0; k < D; ++k) r.e[k] = a.e[k] - b.e[k];
  return r;
}
template <int D, class R, detail::Scalar S>
constexpr Vec<D, detail::Promoted<R, S>> operator*(const Vec<D, R>& a, S s) {
  Vec<D, detail::Promoted<R, S>> r{};
  for (int k = 0; k < D; ++k) r.e[k] = a.e[k] * detail::RealOf<S>(s);
  return r;
}
template <int D, class R, detail::Scalar S>
constexpr Vec<D, detail::Promoted<R, S>> operator*(S s, const Vec<D, R>& a) {
  return a * s;
}
template <int D, class R, detail::Scalar S>
constexpr Vec<D, detail::Promoted<R, S>> operator/(const Vec<D, R>& a, S s) {
  Vec<D, detail::Promoted<R, S>> r{};
  for (int k = 0; k < D; ++k) r.e[k] = a.e[k] / detail::RealOf<S>(s);
  return r;
}
template <int D>
constexpr bool operator==(const Vec<D>& a, const Vec<D>& b) {
  for (int k = 0; k < D; ++k)
    if (!(a.e[k] == b.e[k])) return false;
  return true;
}

template <int D, class A, class B>
constexpr detail::Promoted<A, B> dot(const Vec<D, A>& a, const Vec<D, B>& b) {
  detail::Promoted<A, B> s = a.e[0] * b.e[0];
  for (int k = 1; k < D; ++k) s += a.e[k] * b.e[k];
  return s;
}
template <int D, class R>
constexpr R squared_norm(const Vec<D, R>& a) {
  return dot(a, a);
}
template <int D, class R>
R norm(const Vec<D, R>& a) {
  return sqrt(squared_norm(a));
}
/// a / |a|; not a number for the zero vector.
template <int D, class R>
Vec<D, R> normalized(const Vec<D, R>& a) {
  return a / norm(a);
}
template <class A, class B>
constexpr detail::Promoted<A, B> cross(const Vec<2, A>& a, const Vec<2, B>& b) {
  return a.e[0] * b.e[1] - a.e[1] * b.e[0];
}
template <class A, class B>
constexpr Vec<3, detail::Promoted<A, B>> cross(const Vec<3, A>& a, const Vec<3, B>& b) {
  return {a.e[1] * b.e[2] - a.e[2] * b.e[1], a.e[2] * b.e[0] - a.e[0] * b.e[2],
          a.e[0] * b.e[1] - a.e[1] * b.e[0]};
}
/// a_r b_c
template <int D, class A, class B>
constexpr Mat<D, detail::Promoted<A, B>> outer(const Vec<D, A>& a, const Vec<D, B>& b) {
  Mat<D, detail::Promoted<A, B>> m{};
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) m(r, c) = a.e[r] * b.e[c];
  return m;
}

// Matrices -----------------------------------------------------------------------------------------------------

template <int D, class R = double>
constexpr Mat<D, R> identity() {
  Mat<D, R> m{};
  for (int k = 0; k < D; ++k) m(k, k) = 1.0;
  return m;
}
template <int D, class R>
constexpr Mat<D, R> operator-(const Mat<D, R>& a) {
  Mat<D, R> m{};
  for (int k = 0; k < D * D; ++k) m.e[k] = -a.e[k];
  return m;
}
template <int D, class A, class B>
constexpr Mat<D, detail::Promoted<A, B>> operator+(const Mat<D, A>& a, const Mat<D, B>& b) {
  Mat<D, detail::Promoted<A, B>> m{};
  for (int k = 0; k < D * D; ++k) m.e[k] = a.e[k] + b.e[k];
  return m;
}
template <int D, class A, class B>
constexpr Mat<D, detail::Promoted<A, B>> operator-(const Mat<D, A>& a, const Mat<D, B>& b) {
  Mat<D, detail::Promoted<A, B>> m{};
  for (int k = 0; k < D * D; ++k) m.e[k] = a.e[k] - b.e[k];
  return m;
}
template <int D, class R, detail::Scalar S>
constexpr Mat<D, detail::Promoted<R, S>> operator*(const Mat<D, R>& a, S s) {
  Mat<D, detail::Promoted<R, S>> m{};
  for (int k = 0; k < D * D; ++k) m.e[k] = a.e[k] * detail::RealOf<S>(s);
  return m;
}
template <int D, class R, detail::Scalar S>
constexpr Mat<D, detail::Promoted<R, S>> operator*(S s, const Mat<D, R>& a) {
  return a * s;
}
template <int D, class R, detail::Scalar S>
constexpr Mat<D, detail::Promoted<R, S>> operator/(const Mat<D, R>& a, S s) {
  Mat<D, detail::Promoted<R, S>> m{};
  for (int k = 0; k < D * D; ++k) m.e[k] = a.e[k] / detail::RealOf<S>(s);
  return m;
}
template <int D, class A, class B>
constexpr Vec<D, detail::Promoted<A, B>> operator*(const Mat<D, A>& a, const Vec<D, B>& b) {
  Vec<D, detail::Promoted<A, B>> v{};
  for (int r = 0; r < D; ++r) {
    v.e[r] = a(r, 0) * b.e[0];
    for (int k = 1; k < D; ++k) v.e[r] += a(r, k) * b.e[k];
  }
  return v;
}
template <int D, class A, class B>
constexpr Mat<D, detail::Promoted<A, B>> operator*(const Mat<D, A>& a, const Mat<D, B>& b) {
  Mat<D, detail::Promoted<A, B>> m{};
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) {
      m(r, c) = a(r, 0) * b(0, c);
      for (int k = 1; k < D; ++k) m(r, c) += a(r, k) * b(k, c);
    }
  return m;
}
template <int D>
constexpr bool operator==(const Mat<D>& a, const Mat<D>& b) {
  for (int k = 0; k < D * D; ++k)
    if (!(a.e[k] == b.e[k])) return false;
  return true;
}

template <int D, class R>
constexpr Mat<D, R> transpose(const Mat<D, R>& a) {
  Mat<D, R> m{};
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) m(r, c) = a(c, r);
  return m;
}
template <int D, class R>
constexpr R trace(const Mat<D, R>& a) {
  R s = a(0, 0);
  for (int k = 1; k < D; ++k) s += a(k, k);
  return s;
}
template <int D, class R>
constexpr Mat<D, R> symmetric_part(const Mat<D, R>& a) {
  return 0.5 * (a + transpose(a));
}
/// a : b, the sum of the products of all elements.
template <int D, class A, class B>
constexpr detail::Promoted<A, B> double_dot(const Mat<D, A>& a, const Mat<D, B>& b) {
  detail::Promoted<A, B> s = a.e[0] * b.e[0];
  for (int k = 1; k < D * D; ++k) s += a.e[k] * b.e[k];
  return s;
}
template <class R>
constexpr R determinant(const Mat<2, R>& a) {
  return a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
}
template <class R>
constexpr R determinant(const Mat<3, R>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) +
         a(0, 1) * (a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}
/// Transposed cofactors over the determinant; infinite or not a number if the matrix is singular.
template <class R>
constexpr Mat<2, R> inverse(const Mat<2, R>& a) {
  const R f = 1.0 / determinant(a);
  return {a(1, 1) * f, -a(0, 1) * f, -a(1, 0) * f, a(0, 0) * f};
}
template <class R>
constexpr Mat<3, R> inverse(const Mat<3, R>& a) {
  const R f = 1.0 / determinant(a);
  Mat<3, R> m{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
      m(r, c) = (a(r1, c1) * a(r2, c2) - a(r1, c2) * a(r2, c1)) * f;
    }
  return m;
}

// Between packs and memory -------------------------------------------------------------------------------------

template <int D, class R, class M>
Vec<D, R> select(M mask, const Vec<D, R>& a, const Vec<D, R>& b) {
  Vec<D, R> r{};
  for (int k = 0; k < D; ++k) r.e[k] = select(mask, a.e[k], b.e[k]);
  return r;
}
template <int D, class R, class M>
Mat<D, R> select(M mask, const Mat<D, R>& a, const Mat<D, R>& b) {
  Mat<D, R> r{};
  for (int k = 0; k < D * D; ++k) r.e[k] = select(mask, a.e[k], b.e[k]);
  return r;
}
template <int D, class R>
Vec<D> horizontal_sum(const Vec<D, R>& a) {
  Vec<D> r{};
  for (int k = 0; k < D; ++k) r.e[k] = horizontal_sum(a.e[k]);
  return r;
}
template <int D, class R>
Mat<D> horizontal_sum(const Mat<D, R>& a) {
  Mat<D> r{};
  for (int k = 0; k < D * D; ++k) r.e[k] = horizontal_sum(a.e[k]);
  return r;
}

/// The vectors base[index * D ... + D - 1] of an interleaved array, one per lane.
template <int D>
inline Vec<D, Pack> gather_vec(const double* base, IndexPack index) {
  Vec<D, Pack> r;
  gather_tuple<D>(base, index, r.e);
  return r;
}
template <int D>
inline Vec<D> gather_vec(const double* base, std::size_t index) {
  Vec<D> r;
  gather_tuple<D>(base, index, r.e);
  return r;
}
/// The matrices base[index * D * D ...] of an array of matrices, one per lane.
template <int D>
inline Mat<D, Pack> gather_mat(const double* base, IndexPack index) {
  Mat<D, Pack> r;
  gather_tuple<D * D>(base, index, r.e);
  return r;
}
template <int D>
inline Mat<D> gather_mat(const double* base, std::size_t index) {
  Mat<D> r;
  gather_tuple<D * D>(base, index, r.e);
  return r;
}

static_assert(sizeof(Vec<3>) == 3 * sizeof(double) && std::is_trivially_copyable_v<Vec<3>>);
static_assert(sizeof(Mat<3>) == 9 * sizeof(double) && std::is_trivially_copyable_v<Mat<3>>);

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
