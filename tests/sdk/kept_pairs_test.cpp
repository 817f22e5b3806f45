// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a pair operator keeps beside its neighbour lists: the same bits as when it is computed anew, made once for a
// list and again for the next one, and of every shape that pair code returns.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <random>

#include "shoal/shoal.hpp"
#include "shoal/testing.hpp"

using namespace shoal;
using shoal::testing::Body;

namespace {

std::atomic<int> evaluations;

struct Fresh : PairOperator<Fresh> {
  In<Scalar> f{"f", unit("1"), doc("A field.")};
  In<Array<2, 4>> numbers{"numbers", unit("1"), doc("Some numbers.")};
  Out<Vector> vector{"vector", unit("1"), doc("Sum of vectors.")};
  Out<Matrix> matrix{"matrix", unit("1"), doc("Sum of matrices.")};
  Out<Scalar> number{"number", unit("1"), doc("Sum of numbers.")};

  auto geometry(const auto& p) const { return sums(p.W(), p.grad_W(), outer(p.r_ij(), p.grad_W())); }
  auto combine(const auto& p, const auto& parts) const {
    const auto& [w, gradient, matrix_part] = parts.values;
    const auto theirs = p.j(numbers);
    return sums((p.j(f) - p.i(f)) * gradient, p.j(f) * matrix_part, w * (theirs[1] - p.i(numbers)[0]));
  }
  auto pair(const auto& p) const { return combine(p, geometry(p)); }
  void particle(auto i, auto a, auto b, auto c) const {
    vector[i] = a;
    matrix[i] = b;
    number[i] = c;
  }
};

struct Kept : PairOperator<Kept> {
  In<Scalar> f{"f", unit("1"), doc("A field.")};
  In<Array<2, 4>> numbers{"numbers", unit("1"), doc("Some numbers.")};
  Out<Vector> vector{"vector", unit("1"), doc("Sum of vectors.")};
  Out<Matrix> matrix{"matrix", unit("1"), doc("Sum of matrices.")};
  Out<Scalar> number{"number", unit("1"), doc("Sum of numbers.")};

  auto store(const auto& p) const {
    ++evaluations;
    return sums(p.W(), p.grad_W(), outer(p.r_ij(), p.grad_W()));
  }
  auto pair(const auto& p, const auto& kept) const {
    const auto& [w, gradient, matrix_part] = kept.values;
    const auto theirs = p.j(numbers);
    return sums((p.j(f) - p.i(f)) * gradient, p.j(f) * matrix_part, w * (theirs[1] - p.i(numbers)[0]));
  }
  void particle(auto i, auto a, auto b, auto c) const {
    vector[i] = a;
    matrix[i] = b;
    number[i] = c;
  }
};

Body random_body(int dimensions, std::size_t n) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0.0, 0.1), value(-1.0, 1.0);
  std::vector<double> x(n * static_cast<std::size_t>(dimensions));
  for (double& component : x) component = place(random);
  Body body(dimensions, std::move(x));
  body.set_each("f", 1, [&](std::size_t, std::size_t) { return value(random); });
  body.set_each("numbers", dimensions == 2 ? 2 : 4, [&](std::size_t, std::size_t) { return value(random); });
  return body;
}

}  // namespace

TEST_CASE("kept values give what fresh ones give, and the same bits in every pass") {
  for (const int dimensions : {2, 3})
    for (const bool scalar : {false, true}) {
      Body fresh_body = random_body(dimensions, 61), kept_body = random_body(dimensions, 61);
      const testing::Setup setup{.smoothing_length = 0.02, .scalar = scalar};
      Fresh fresh;
      Kept kept;
      testing::run(fresh, fresh_body, {&fresh_body}, setup);
      testing::run(kept, kept_body, {&kept_body}, setup);
      for (const char* field : {"vector", "matrix", "number"}) {
        const auto first_pass = kept_body[field];
        const auto& expected = fresh_body[field];
        REQUIRE(first_pass.size() == expected.size());
        double largest = 0;
        for (const double value : expected) largest = std::max(largest, std::abs(value));
        for (std::size_t k = 0; k < expected.size(); ++k)
          CHECK(std::abs(first_pass[k] - expected[k]) <= 1e-14 * largest);
        testing::run(kept, kept_body, {&kept_body}, setup);
        CHECK(std::memcmp(first_pass.data(), kept_body[field].data(), first_pass.size() * sizeof(double)) ==
              0);
      }
    }
}

TEST_CASE("a list is stored once, and a new one anew") {
  Body body = random_body(2, 40);
  Kept kept;
  const testing::Setup setup{.smoothing_length = 0.02};
  testing::run(kept, body, {&body}, setup);
  const auto first = body["number"];
  const int once = evaluations;
  for (double& f : body["f"]) f *= 2.0;
  testing::run(kept, body, {&body}, setup);  // the same list
  CHECK(evaluations == once);
  CHECK(body["number"] == first);
  for (double& x : body["position"]) x *= 0.999;
  testing::Setup renewed = setup;
  renewed.generation = 2;
  testing::run(kept, body, {&body}, renewed);
  CHECK(evaluations > once);
  CHECK(body["number"] != first);
}

TEST_CASE("operators say what they keep for each pair") {
  Kept kept;
  kept.set_dimensions(2);
  CHECK(kept.bytes_per_pair() == 8 * (1 + 2 + 4));
  kept.set_dimensions(3);
  CHECK(kept.bytes_per_pair() == 8 * (1 + 3 + 9));
  CHECK(Fresh().bytes_per_pair() == 0);
}
