// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Vec and Mat against Eigen, and Vec and Mat of packs against those of double.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <random>

#include "shoal/eigen.hpp"
#include "shoal/vec.hpp"

namespace {

using shoal::as_eigen;
using shoal::lanes;
using shoal::Mat;
using shoal::Pack;
using shoal::Vec;

std::mt19937_64 generator(11);  // NOLINT: a fixed seed is wanted
double uniform() { return std::uniform_real_distribution<double>(-2, 2)(generator); }

template <int D>
Vec<D> random_vec() {
  Vec<D> v;
  for (double& x : v.e) x = uniform();
  return v;
}
template <int D>
Mat<D> random_mat() {
  Mat<D> m;
  for (double& x : m.e) x = uniform();
  return m;
}

// |a - b| of two Eigen expressions
template <class A, class B>
double difference(const A& a, const B& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

template <int D>
void check_against_eigen() {
  const double tolerance = 1e-14;  // sums of at most 9 products of numbers below 2: a few rounding errors
  for (int trial = 0; trial < 200; ++trial) {
    const Vec<D> a = random_vec<D>(), b = random_vec<D>();
    const Mat<D> m = random_mat<D>(), n = random_mat<D>();
    const double s = uniform();
    const auto ea = as_eigen(a), eb = as_eigen(b);
    const auto em = as_eigen(m), en = as_eigen(n);

    const Vec<D> sum = a + b, minus = a - b, scaled = s * a, divided = a / 3, negative = -a, mapped = m * a;
    CHECK(difference(as_eigen(sum), ea + eb) == 0.0);
    CHECK(difference(as_eigen(minus), ea - eb) == 0.0);
    CHECK(difference(as_eigen(scaled), s * ea) < tolerance);
    CHECK(difference(as_eigen(divided), ea / 3.0) == 0.0);
    CHECK(difference(as_eigen(negative), -ea) == 0.0);
    CHECK(difference(as_eigen(mapped), em * ea) < tolerance);
    CHECK(std::abs(dot(a, b) - ea.dot(eb)) < tolerance);
    CHECK(std::abs(norm(a) - ea.norm()) < tolerance);
    CHECK(std::abs(norm(normalized(a)) - 1.0) < tolerance);

    const Mat<D> product = m * n, dyad = outer(a, b), turned = transpose(m), sym = symmetric_part(m);
    CHECK(difference(as_eigen(product), em * en) < tolerance);
    CHECK(difference(as_eigen(dyad), ea * eb.transpose()) < tolerance);
    CHECK(difference(as_eigen(turned), em.transpose()) == 0.0);
    CHECK(difference(as_eigen(sym), 0.5 * (em + em.transpose())) == 0.0);
    CHECK(std::abs(trace(m) - em.trace()) < tolerance);
    CHECK(std::abs(double_dot(m, n) - em.cwiseProduct(en).sum()) < tolerance);
    CHECK(std::abs(determinant(m) - em.determinant()) < 2e-14);

    // Well away from singular, so that the inverse has a bound.
    const Mat<D> regular = m + 8.0 * shoal::identity<D>();
    const Mat<D> one = inverse(regular) * regular;
    CHECK(difference(as_eigen(one), Eigen::Matrix<double, D, D>::Identity()) < tolerance);
    CHECK(shoal::to_vec<D>(ea + eb) == sum);
    CHECK(shoal::to_mat<D>(em * 2.0) == m * 2.0);
  }
}

template <int D>
void check_packs() {
  // One lane at a time: a pack made of `lanes` random cases must give the scalar answers.
  Vec<D> a[8], b[8];
  Mat<D> m[8];
  double s[8];
  Vec<D, Pack> pa{}, pb{};
  Mat<D, Pack> pm{};
  Pack ps{};
  for (int k = 0; k < lanes; ++k) {
    a[k] = random_vec<D>();
    b[k] = random_vec<D>();
    m[k] = random_mat<D>() + 6.0 * shoal::identity<D>();
    s[k] = uniform();
    for (int c = 0; c < D; ++c) pa[c].set(k, a[k][c]);
    for (int c = 0; c < D; ++c) pb[c].set(k, b[k][c]);
    for (int c = 0; c < D * D; ++c) pm[c].set(k, m[k][c]);
    ps.set(k, s[k]);
  }
  const Vec<D> constant = random_vec<D>();
  const auto pack_result = inverse(pm) * (pa * ps + constant) - pb / (2.0 + ps * ps) + dot(pa, pb) * constant;
  const auto pack_matrix = outer(pa, constant) + pm * ps - 2.0 * transpose(pm);
  const Vec<D, Pack> chosen = select(ps < 0.0, pa, pb);
  for (int k = 0; k < lanes; ++k) {
    const auto expected =
        inverse(m[k]) * (a[k] * s[k] + constant) - b[k] / (2.0 + s[k] * s[k]) + dot(a[k], b[k]) * constant;
    const auto matrix = outer(a[k], constant) + m[k] * s[k] - 2.0 * transpose(m[k]);
    for (int c = 0; c < D; ++c) CHECK(std::abs(pack_result[c][k] - expected[c]) < 1e-14);
    for (int c = 0; c < D * D; ++c) CHECK(std::abs(pack_matrix[c][k] - matrix[c]) < 1e-14);
    for (int c = 0; c < D; ++c) CHECK(chosen[c][k] == (s[k] < 0.0 ? a[k][c] : b[k][c]));
  }
}

}  // namespace

TEST_CASE("vectors and matrices agree with Eigen") {
  check_against_eigen<2>();
  check_against_eigen<3>();
}

TEST_CASE("vectors and matrices of packs agree with those of double in every lane") {
  for (int trial = 0; trial < 50; ++trial) {
    check_packs<2>();
    check_packs<3>();
  }
}

TEST_CASE("cross products") {
  CHECK(cross(Vec<2>{1, 2}, Vec<2>{3, 5}) == -1.0);
  CHECK(cross(Vec<3>{1, 0, 0}, Vec<3>{0, 1, 0}) == Vec<3>{0, 0, 1});
  const Vec<3> a = random_vec<3>(), b = random_vec<3>();
  CHECK(std::abs(dot(cross(a, b), a)) < 1e-14);
  CHECK(std::abs(dot(cross(a, b), b)) < 1e-14);
}

TEST_CASE("vector arithmetic is usable in constant expressions") {
  constexpr Vec<3> a{1, 2, 3};
  static_assert(dot(a, a) == 14.0);
  static_assert(determinant(shoal::identity<3>() * 2.0) == 8.0);
  static_assert((a + a)[2] == 6.0);
  static_assert(inverse(Mat<2>{2, 0, 0, 4})(1, 1) == 0.25);
}

TEST_CASE("an Eigen view writes through") {
  Vec<3> a{1, 2, 3};
  as_eigen(a) *= 2.0;
  CHECK(a == Vec<3>{2, 4, 6});
  Mat<2> m{1, 2, 3, 4};
  as_eigen(m).transposeInPlace();
  CHECK(m == Mat<2>{1, 3, 2, 4});
}

TEST_CASE("gather_vec and gather_mat read interleaved arrays") {
  std::vector<double> base(9 * 50);
  for (std::size_t k = 0; k < base.size(); ++k) base[k] = static_cast<double>(k);
  const std::uint32_t index[8] = {0, 49, 7, 7, 13, 2, 31, 40};
  const auto pack = shoal::IndexPack::load(index);
  const auto v = shoal::gather_vec<3>(base.data(), pack);
  const auto m = shoal::gather_mat<3>(base.data(), pack);
  for (int k = 0; k < lanes; ++k) {
    for (int c = 0; c < 3; ++c) CHECK(v[c][k] == 3 * index[k] + static_cast<unsigned>(c));
    for (int c = 0; c < 9; ++c) CHECK(m[c][k] == 9 * index[k] + static_cast<unsigned>(c));
    CHECK(shoal::gather_vec<3>(base.data(), std::size_t{index[k]})[2] == v[2][k]);
    CHECK(shoal::gather_mat<3>(base.data(), std::size_t{index[k]})[8] == m[8][k]);
  }
  const auto total = horizontal_sum(v);
  double expected = 0;
  for (int k = 0; k < lanes; ++k) expected += 3.0 * index[k] + 1;
  CHECK(total[1] == expected);
}
