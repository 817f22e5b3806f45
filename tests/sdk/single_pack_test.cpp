// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// SinglePack lane by lane against plain floats.
#include "shoal/single_pack.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "shoal/vec.hpp"

using namespace shoal;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

struct Lanes {
  float x[single_lanes];
  explicit Lanes(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-3.0F, 3.0F);
    for (float& lane : x) lane = uniform(random);
  }
  SinglePack pack() const { return SinglePack::load(x); }
};

// The same bits: NaN and the sign of zero count.
bool same(double got, float wanted) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(got)) == std::bit_cast<std::uint32_t>(wanted) ||
         (std::isnan(got) && std::isnan(wanted));
}

}  // namespace

TEST_CASE("arithmetic, comparisons and selection are those of floats in each lane") {
  for (std::uint32_t seed = 1; seed < 20; ++seed) {
    Lanes a(seed), b(seed + 100);
    a.x[0] = not_a_number;
    b.x[1] = not_a_number;
    a.x[2] = b.x[2] = 0.5F;
    const SinglePack p = a.pack(), q = b.pack();
    const SingleMask less = p < q, equal = p == q, at_least = p >= q;
    const SinglePack smaller = min(p, q), larger = max(p, q), chosen = select(less, p, q);
    for (int k = 0; k < single_lanes; ++k) {
      CAPTURE(k);
      const float x = a.x[k], y = b.x[k];
      CHECK(same((p + q)[k], x + y));
      CHECK(same((p - q)[k], x - y));
      CHECK(same((p * q)[k], x * y));
      CHECK(same((p / q)[k], x / y));
      CHECK(same((-p)[k], -x));
      CHECK(same(abs(p)[k], std::fabs(x)));
      CHECK(same(sqrt(abs(p))[k], std::sqrt(std::fabs(x))));
      CHECK(less[k] == (x < y));
      CHECK(equal[k] == (x == y));
      CHECK(at_least[k] == (x >= y));
      CHECK(same(smaller[k], x < y ? x : y));
      CHECK(same(larger[k], x > y ? x : y));
      CHECK(same(chosen[k], x < y ? x : y));
      CHECK((!less)[k] == !(x < y));
      CHECK((less || equal)[k] == (x <= y));
    }
    CHECK(any(equal));
    CHECK(!all(equal));
    CHECK(none(p > SinglePack(10.0)));
  }
}

TEST_CASE("numbers in double precision are rounded to the nearest, two packs to one and back") {
  Pack low, high;
  for (int k = 0; k < lanes; ++k) {
    low.set(k, 1.0 / 3.0 + k);
    high.set(k, -1.0 / 7.0 - k);
  }
  const SinglePack joined = SinglePack::join(low, high);
  for (int k = 0; k < lanes; ++k) {
    CHECK(joined[k] == static_cast<float>(low[k]));
    CHECK(joined[lanes + k] == static_cast<float>(high[k]));
    CHECK(joined.low()[k] == static_cast<float>(low[k]));
    CHECK(joined.high()[k] == static_cast<float>(high[k]));
    CHECK(SinglePack(0.1)[k] == static_cast<double>(0.1F));
  }
}

TEST_CASE("inverse root and reciprocal of single packs are good to two units in the last place") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> mantissa(1.0F, 4.0F);
  std::uniform_int_distribution<int> exponent(-110, 110);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    float x[single_lanes];
    for (float& lane : x) lane = std::ldexp(mantissa(random), exponent(random));
    const SinglePack root = inverse_sqrt(SinglePack::load(x)), inverse = reciprocal(SinglePack::load(x));
    const auto units_off = [](double value, double exact) {
      return std::abs(value - exact) / std::ldexp(1.0, std::ilogb(exact) - 23);
    };
    for (int k = 0; k < single_lanes; ++k)
      worst = std::max({worst, units_off(root[k], 1.0 / std::sqrt(static_cast<double>(x[k]))),
                        units_off(inverse[k], 1.0 / static_cast<double>(x[k]))});
  }
  CHECK(worst <= 2.0);
  CHECK(std::isnan(inverse_sqrt(SinglePack(not_a_number))[0]));
}

TEST_CASE("the sum of all lanes is in double precision") {
  Lanes a(3);
  a.x[0] = 1e8F;
  double sum = 0;
  for (const float x : a.x) sum += static_cast<double>(x);
  CHECK(horizontal_sum(a.pack()) == doctest::Approx(sum).epsilon(1e-14));
}

TEST_CASE("sums of several packs are summed together, of four lanes in single precision") {
  SinglePack packs[7];
  double sums[7];
  std::vector<Lanes> lanes_of;
  for (unsigned k = 0; k < 7; ++k) {
    lanes_of.emplace_back(30 + k);
    packs[k] = lanes_of[k].pack();
  }
  const auto check = [&](int n) {
    for (int k = 0; k < n; ++k) {
      double exact = 0, largest = 0;
      for (const float x : lanes_of[static_cast<std::size_t>(k)].x) {
        exact += static_cast<double>(x);
        largest += std::abs(static_cast<double>(x));
      }
      CHECK(std::abs(sums[k] - exact) <= 1.2e-7 * largest);
      // Each by itself is the same as among others.
      double alone = 0;
      horizontal_sums<1>(packs + k, &alone);
      CHECK(alone == sums[k]);
    }
  };
  horizontal_sums<7>(packs, sums);
  check(7);
  horizontal_sums<4>(packs, sums);
  check(4);
  horizontal_sums<2>(packs, sums);
  check(2);
}

TEST_CASE("the first lanes are those below n, none and all at the ends") {
  for (std::int64_t n = -2; n <= single_lanes + 2; ++n)
    for (int k = 0; k < single_lanes; ++k) CHECK(first_single_lanes(n)[k] == (k < n));
}

TEST_CASE("records and rows of doubles are gathered lane by lane") {
  std::mt19937 random(9);
  std::uniform_int_distribution<std::uint32_t> uniform(0, 99);
  std::vector<float> records(100 * 8);
  std::vector<double> vectors(100 * 3 + 1);
  for (std::size_t k = 0; k < records.size(); ++k) records[k] = 0.5F * static_cast<float>(k);
  for (std::size_t k = 0; k < vectors.size(); ++k) vectors[k] = static_cast<double>(k) / 3.0;
  std::uint32_t low[lanes], high[lanes];
  for (std::uint32_t& j : low) j = uniform(random);
  for (std::uint32_t& j : high) j = uniform(random);
  const SingleIndexPack j{low, high};
  SinglePack four[4], three[3];
  gather_four<8>(records.data() + 4, j, four);
  gather_tuple<3>(vectors.data(), j, three);
  for (int k = 0; k < single_lanes; ++k) {
    for (std::size_t c = 0; c < 4; ++c) CHECK(four[c][k] == records[j[k] * 8 + 4 + c]);
    for (std::size_t c = 0; c < 3; ++c) CHECK(three[c][k] == static_cast<float>(vectors[j[k] * 3 + c]));
  }
}

TEST_CASE("differences of whole numbers are exact, and wrap around") {
  const auto holding = [](std::uint32_t whole) {
    return SinglePack::from_raw(simd::single::broadcast(std::bit_cast<float>(whole)));
  };
  const auto difference = [&](std::uint32_t a, std::uint32_t b) {
    return SinglePack::from_raw(simd::single::difference(holding(a).v, holding(b).v))[single_lanes - 1];
  };
  CHECK(difference(1000, 7) == 993.0);
  CHECK(difference(7, 1000) == -993.0);
  CHECK(difference(3, 0xFFFFFFFE) == 5.0);
  CHECK(difference(0x80000001, 0x7FFFFFFF) == 2.0);
  CHECK(difference(0x7FC00000, 0x7FA00000) == 0x200000);  // bits of NaN
}

TEST_CASE("vectors of single packs mix with vectors of numbers") {
  const Vec<3> a{1.0, 2.0, 3.0};
  const Vec<3, SinglePack> b{SinglePack(0.5), SinglePack(-1.0), SinglePack(2.0)};
  CHECK(dot(a, b)[0] == 4.5);
  CHECK((a - b)[2][single_lanes - 1] == 1.0);
  CHECK(horizontal_sum(2.0 * b)[0] == single_lanes);
}
