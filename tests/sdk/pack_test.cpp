// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Every function of Pack against the same function of double, lane by lane and bit by bit, on numbers that include
// zeros of both signs, infinities, denormals and NaN.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "shoal/pack.hpp"
#include "shoal/pack_scatter.hpp"

namespace {

using shoal::IndexPack;
using shoal::lanes;
using shoal::Mask;
using shoal::Pack;

bool same_bits(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return true;  // sign and payload of a NaN are nobody's promise
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::vector<double> awkward_numbers() {
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<double> x = {0.0,
                           -0.0,
                           1.0,
                           -1.0,
                           0.5,
                           -3.25,
                           1e300,
                           -1e-300,
                           inf,
                           -inf,
                           std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::denorm_min(),
                           2.0};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-10, 10);
  while (x.size() < 29) x.push_back(uniform(random));
  return x;
}

// Calls check(a, b, lane values) for packs in which every pair of awkward numbers meets in some lane.
template <class Check>
void for_pairs(Check check) {
  const auto x = awkward_numbers();
  const auto n = x.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      double a[lanes], b[lanes];
      for (int k = 0; k < lanes; ++k) {
        a[k] = x[(i + 3 * static_cast<std::size_t>(k)) % n];
        b[k] = x[(j + 5 * static_cast<std::size_t>(k)) % n];
      }
      check(Pack::load(a), Pack::load(b), a, b);
    }
}

}  // namespace

TEST_CASE("pack arithmetic equals scalar arithmetic in every lane") {
  int wrong = 0;
  for_pairs([&](Pack a, Pack b, const double* x, const double* y) {
    const auto check = [&](Pack got, auto&& expected) {
      for (int k = 0; k < lanes; ++k) wrong += !same_bits(got[k], expected(x[k], y[k]));
    };
    check(a + b, [](double p, double q) { return p + q; });
    check(a - b, [](double p, double q) { return p - q; });
    check(a * b, [](double p, double q) { return p * q; });
    check(a / b, [](double p, double q) { return p / q; });
    check(-a, [](double p, double) { return -p; });
    check(2.5 - a, [](double p, double) { return 2.5 - p; });
    check(a / 3.0, [](double p, double) { return p / 3.0; });
    check(min(a, b), [](double p, double q) { return shoal::min(p, q); });
    check(max(a, b), [](double p, double q) { return shoal::max(p, q); });
    check(max(0.0, a), [](double p, double) { return shoal::max(0.0, p); });
    check(abs(a), [](double p, double) { return shoal::abs(p); });
    check(sqrt(abs(a)), [](double p, double) { return shoal::sqrt(shoal::abs(p)); });
    check(exp(a), [](double p, double) { return shoal::exp(p); });
    check(log(abs(a)), [](double p, double) { return shoal::log(shoal::abs(p)); });
    check(pow(abs(a), b), [](double p, double q) { return shoal::pow(shoal::abs(p), q); });
    check(select(a < b, a, b), [](double p, double q) { return shoal::select(p < q, p, q); });
    Pack c = a;
    c += b;
    c *= 2.0;
    c -= a;
    c /= 0.5;
    check(c, [](double p, double q) { return ((p + q) * 2.0 - p) / 0.5; });
  });
  CHECK(wrong == 0);
}

TEST_CASE("comparisons and masks equal their scalar counterparts") {
  int wrong = 0;
  for_pairs([&](Pack a, Pack b, const double* x, const double* y) {
    const Mask less = a < b, equal = a == b;
    for (int k = 0; k < lanes; ++k) {
      wrong += less[k] != (x[k] < y[k]);
      wrong += (a <= b)[k] != (x[k] <= y[k]);
      wrong += (a > b)[k] != (x[k] > y[k]);
      wrong += (a >= b)[k] != (x[k] >= y[k]);
      wrong += equal[k] != (x[k] == y[k]);
      wrong += (a != b)[k] != (x[k] != y[k]);
      wrong += (less & equal)[k] != false;
      wrong += (less | equal)[k] != (x[k] <= y[k]);
      wrong += (!less)[k] != !(x[k] < y[k]);
      wrong += (less && true)[k] != less[k];
    }
  });
  CHECK(wrong == 0);
}

TEST_CASE("max and min with the limit first let a NaN through") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(shoal::max(0.0, nan)));
  CHECK(std::isnan(shoal::min(0.0, nan)));
  const Pack high = max(0.0, Pack(nan)), low = min(0.0, Pack(nan));
  for (int k = 0; k < lanes; ++k) {
    CHECK(std::isnan(high[k]));
    CHECK(std::isnan(low[k]));
  }
}

TEST_CASE("any, all, none and first_lanes") {
  for (int n = -2; n <= lanes + 9; ++n) {
    const Mask mask = shoal::first_lanes(n);
    for (int k = 0; k < lanes; ++k) CHECK(mask[k] == (k < n));
    CHECK(any(mask) == (n > 0));
    CHECK(all(mask) == (n >= lanes));
    CHECK(none(mask) == (n <= 0));
  }
  CHECK(all(Mask(true)));
  CHECK(none(Mask(false)));
}

TEST_CASE("horizontal_sum adds halves in the documented order") {
  // Numbers whose sum depends on the order: 1e16 swallows a lone 1 but not a 2.
  double x[8] = {1e16, 1.0, -1e16, 3.0, 1.0, -1.0, 1.0, 1e-3};
  const double tree8 = ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
  const double tree4 = (x[0] + x[2]) + (x[1] + x[3]);
  CHECK(horizontal_sum(Pack::load(x)) == (lanes == 8 ? tree8 : tree4));
  CHECK(horizontal_min(Pack::load(x)) == -1e16);
  CHECK(horizontal_max(Pack::load(x)) == 1e16);
  CHECK(shoal::horizontal_sum(2.5) == 2.5);
}

TEST_CASE("load, store and lane access need no alignment") {
  std::vector<double> in(40), out(40, -1.0);
  for (std::size_t k = 0; k < in.size(); ++k) in[k] = 0.5 * static_cast<double>(k);
  for (std::size_t shift = 0; shift < 9; ++shift) {
    Pack p = Pack::load(in.data() + shift);
    p.set(1, 77.0);
    p.store(out.data() + shift);
    for (std::size_t k = 0; k < static_cast<std::size_t>(lanes); ++k)
      CHECK(out[shift + k] == (k == 1 ? 77.0 : in[shift + k]));
  }
}

TEST_CASE("gather reads one component of an interleaved array") {
  std::vector<double> base(3 * 1000);
  for (std::size_t k = 0; k < base.size(); ++k) base[k] = static_cast<double>(k);
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    std::uint32_t index[8];
    for (auto& i : index) i = static_cast<std::uint32_t>(random() % 1000);
    const IndexPack pack = IndexPack::load(index);
    const Pack plain = shoal::gather(base.data(), pack);
    const Pack last_of_two = shoal::gather<2, 1>(base.data(), pack);
    const Pack last_of_three = shoal::gather<3, 2>(base.data(), pack);
    for (int k = 0; k < lanes; ++k) {
      CHECK(pack[k] == index[k]);
      CHECK(plain[k] == index[k]);
      CHECK(last_of_two[k] == 2 * index[k] + 1);
      CHECK(last_of_three[k] == 3 * index[k] + 2);
      CHECK(shoal::gather<3, 2>(base.data(), std::size_t{index[k]}) == last_of_three[k]);
    }
  }
}

template <int N, int Stride>
void check_tuple() {
  std::vector<double> base(Stride * 100 + 1);
  for (std::size_t k = 0; k < base.size(); ++k) base[k] = static_cast<double>(k);
  std::mt19937 random(N);
  std::uint32_t index[8];
  for (auto& i : index) i = static_cast<std::uint32_t>(random() % 100);
  index[1] = 99;
  Pack packs[N];
  shoal::gather_tuple<N, Stride>(base.data(), IndexPack::load(index), packs);
  for (int k = 0; k < lanes; ++k) {
    double numbers[N];
    shoal::gather_tuple<N, Stride>(base.data(), std::size_t{index[k]}, numbers);
    for (int c = 0; c < N; ++c) {
      CHECK(packs[c][k] == Stride * index[k] + static_cast<std::uint32_t>(c));
      CHECK(numbers[c] == packs[c][k]);
    }
  }
}

TEST_CASE("gather_tuple reads numbers that lie together") {
  check_tuple<1, 1>();
  check_tuple<2, 2>();
  check_tuple<3, 3>();
  check_tuple<4, 4>();
  check_tuple<5, 5>();
  check_tuple<6, 6>();
  check_tuple<7, 7>();
  check_tuple<9, 9>();
  check_tuple<27, 27>();
  check_tuple<2, 5>();
  check_tuple<4, 9>();
}

template <int N, int Stride>
void check_scatter() {
  constexpr std::size_t n = 40;
  std::vector<double> base(n * Stride + 1, -1.0);
  std::uint32_t index[lanes];
  for (int k = 0; k < lanes; ++k) index[k] = static_cast<std::uint32_t>((7 * k + 3) % 37);
  index[lanes - 1] = index[0];  // two lanes that hold the same numbers
  Pack packs[N];
  for (int c = 0; c < N; ++c)
    for (int k = 0; k < lanes; ++k) packs[c].set(k, 100.0 * index[k] + c);
  shoal::scatter_tuple<N, Stride>(packs, IndexPack::load(index), base.data());
  for (std::uint32_t i = 0; i < n; ++i) {
    const bool written = std::find(index, index + lanes, i) != index + lanes;
    for (int c = 0; c < Stride; ++c)
      CHECK(base[i * Stride + static_cast<std::uint32_t>(c)] == (written && c < N ? 100.0 * i + c : -1.0));
  }
  CHECK(base.back() == -1.0);
}

TEST_CASE("scatter_tuple writes what gather_tuple reads, and nothing else") {
  check_scatter<1, 1>();
  check_scatter<2, 2>();
  check_scatter<3, 3>();
  check_scatter<4, 4>();
  check_scatter<9, 9>();
  check_scatter<2, 5>();
  check_scatter<4, 9>();
  check_scatter<5, 6>();
}

TEST_CASE("numbers in single precision are read as they are and written to the nearest") {
  float out[lanes];
  const Pack x = Pack::from([](int lane) { return 1.0 / (3.0 + lane); });
  x.store(out);
  const Pack back = Pack::load(out);
  for (int lane = 0; lane < lanes; ++lane) {
    CHECK(out[lane] == static_cast<float>(x[lane]));
    CHECK(back[lane] == static_cast<double>(out[lane]));
  }
}

TEST_CASE("inverse root and reciprocal are good to two units in the last place over all magnitudes") {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> mantissa(1.0, 4.0), exponent(-660.0, 660.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    Pack x;
    for (int lane = 0; lane < lanes; ++lane)
      x.set(lane, std::ldexp(mantissa(random), static_cast<int>(exponent(random))));
    const Pack root = inverse_sqrt(x), y = reciprocal(x);
    const auto units_off = [](double value, long double exact) {
      const double unit = std::ldexp(1.0, std::ilogb(static_cast<double>(exact)) - 52);
      return std::abs(static_cast<double>((value - exact) / unit));
    };
    for (int lane = 0; lane < lanes; ++lane) {
      const auto exact = static_cast<long double>(x[lane]);
      worst =
          std::max({worst, units_off(root[lane], 1.0L / std::sqrt(exact)), units_off(y[lane], 1.0L / exact)});
    }
  }
  CHECK(worst <= 2.0);
  CHECK(std::isnan(inverse_sqrt(Pack(nan))[0]));
  CHECK(std::isnan(reciprocal(Pack(nan))[0]));
}
