// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators of the SDK on bodies made by hand: the pair loop with packs and with one neighbour after the other against
// a plain loop over all pairs, fields, reductions, time steps, and the callbacks that the kernel sees.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "shoal/shoal.hpp"
#include "shoal/testing.hpp"

using namespace shoal;
using shoal::testing::Body;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// All shapes of fields and results: sum_j q_j W, sum_j q_j (v_i - v_j) . r_ij W' / r, sum_j q_j A_j grad W.
struct Everything : PairOperator<Everything> {
  In<Scalar> weight{"weight", neighbours_only, unit("1"), doc("Weight.")};
  In<Vector> velocity{"velocity"};
  In<Matrix> gradient{"gradient", unit("1/s"), doc("Gradient.")};
  Out<Scalar> number{"number", unit("1"), doc("Sum of numbers.")};
  Out<Vector> vector{"vector", unit("1"), doc("Sum of vectors.")};
  Out<Matrix> matrix{"matrix", unit("1"), doc("Sum of matrices.")};

  auto pair(const auto& p) const {
    const auto q = p.j(weight);
    return sums(q * p.W() + dot(p.i(velocity) - p.j(velocity), p.e()) * p.dW(),
                q * (p.j(gradient) * p.grad_W()), (q * p.dW_over_r()) * (p.i(gradient) + p.j(gradient)));
  }
  void particle(auto i, auto a, auto b, auto c) const {
    number[i] = a;
    vector[i] = b;
    matrix[i] = c;
  }
};

Body random_body(int dimensions, std::size_t n, double side, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0.0, side), value(-1.0, 1.0);
  const auto d = static_cast<std::size_t>(dimensions);
  std::vector<double> x(n * d);
  for (double& component : x) component = place(random);
  Body body(dimensions, std::move(x));
  const auto any = [&](std::size_t, std::size_t) { return value(random); };
  body.set_each("weight", 1, any);
  body.set_each("velocity", d, any);
  body.set_each("gradient", d * d, any);
  return body;
}

// The same sums, written out for numbers in arrays.
struct Plain {
  double number = 0, scale = 0;
  std::array<double, 3> vector{};
  std::array<double, 9> matrix{};
};

template <int D>
Plain plain_sums(Body& own, const std::vector<Body*>& others, SmoothingKernel kind, double h, std::size_t i) {
  constexpr std::size_t d = D;
  Plain sum;
  with_kernel<D>(kind, h, [&](const auto& kernel) {
    for (Body* other : others)
      for (std::size_t j = 0; j < other->size(); ++j) {
        if (other == &own && i == j) continue;
        double r_ij[d], squared = 0, v_e = 0;
        for (std::size_t a = 0; a < d; ++a) {
          r_ij[a] = own["position"][d * i + a] - (*other)["position"][d * j + a];
          squared += r_ij[a] * r_ij[a];
        }
        const double r = std::sqrt(squared);
        if (r >= kernel.cutoff()) continue;
        const double q = (*other)["weight"][j];
        for (std::size_t a = 0; a < d; ++a)
          v_e += (own["velocity"][d * i + a] - (*other)["velocity"][d * j + a]) * r_ij[a] / r;
        sum.number += q * kernel.w(r) + v_e * kernel.dw(r);
        sum.scale += kernel.w(0.0);
        for (std::size_t a = 0; a < d; ++a)
          for (std::size_t b = 0; b < d; ++b) {
            const double theirs = (*other)["gradient"][d * d * j + d * a + b];
            sum.vector[a] += q * theirs * kernel.dw_over_r(r) * r_ij[b];
            sum.matrix[d * a + b] +=
                q * kernel.dw_over_r(r) * (own["gradient"][d * d * i + d * a + b] + theirs);
          }
      }
  });
  return sum;
}

// Relative to the size of the terms, so that sums that nearly cancel are not held against the order of adding.
template <int D>
void check_against_plain(Body& own, const std::vector<Body*>& others, SmoothingKernel kind, double h) {
  for (const bool scalar : {false, true}) {
    Everything op;
    testing::run(op, own, others, {.smoothing_length = h, .smoothing_kernel = kind, .scalar = scalar});
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Plain plain = plain_sums<D>(own, others, kind, h, i);
      const double tiny = 1e-12 * (plain.scale + std::abs(plain.number));
      CAPTURE(i);
      CAPTURE(scalar);
      CHECK(std::abs(own["number"][i] - plain.number) <= tiny);
      for (std::size_t a = 0; a < D; ++a)
        CHECK(std::abs(own["vector"][D * i + a] - plain.vector[a]) <= tiny / h * 10);
      for (std::size_t a = 0; a < D * D; ++a)
        CHECK(std::abs(own["matrix"][D * D * i + a] - plain.matrix[a]) <= tiny / (h * h) * 10);
    }
  }
}

template <int D>
struct Row {
  Body centre, neighbours;
};

// One particle with n neighbours in another body, on a small sphere so that all are inside the cut-off.
template <int D>
Row<D> row_of(std::size_t n) {
  Row<D> row{random_body(D, 1, 0.0, 5), random_body(D, n, 0.1, 6)};
  return row;
}

struct Counter : PairOperator<Counter> {
  Out<Scalar> count{"count"};
  auto pair(const auto& p) const { return 0.0 * p.r() + 1.0; }
  void particle(auto i, auto sum) const { count[i] = sum; }
};

struct LonelyCounter : PairOperator<LonelyCounter> {
  static constexpr bool skips_lonely = true;
  Out<Scalar> count{"count"};
  auto pair(const auto& p) const { return 0.0 * p.r() + 1.0; }
  void particle(auto i, auto sum) const { count[i] = sum; }
};

struct Statistics : ParticleOperator<Statistics> {
  In<Scalar> value{"value"};
  Accumulate<Vector> added{"added"};
  Sum total;
  Minimum least;
  Maximum largest;
  double seen = 0;

  void particle(auto i) const {
    total.update(i, value[i]);
    least.update(i, value[i]);
    largest.update(i, value[i]);
    added[i][0] += value[i];
  }
  void end() { seen = total.result(); }
};

struct LimitedStep : ParticleOperator<LimitedStep> {
  In<Scalar> limit{"limit"};
  void particle(auto) const {}
  double time_step_of(auto i) const { return limit[i]; }
};

}  // namespace

TEST_CASE("the pair loop adds what a plain loop adds: packs and single neighbours, every smoothing kernel") {
  for (std::size_t k = 0; k < smoothing_kernel_names.size(); ++k) {
    CAPTURE(smoothing_kernel_names[k]);
    const auto kind = static_cast<SmoothingKernel>(k);
    Body flat = random_body(2, 120, 1.0, 1), solid = random_body(3, 120, 1.0, 2);
    check_against_plain<2>(flat, {&flat}, kind, 0.15);
    check_against_plain<3>(solid, {&solid}, kind, 0.2);
  }
}

TEST_CASE("sums run over all neighbour bodies, whether the own one is among them or not") {
  Body own = random_body(3, 60, 1.0, 1), wall = random_body(3, 40, 1.0, 2), gate = random_body(3, 7, 1.0, 3);
  check_against_plain<3>(own, {&own, &wall, &gate}, SmoothingKernel::wendland_c2, 0.25);
  check_against_plain<3>(own, {&wall, &gate}, SmoothingKernel::wendland_c2, 0.25);
}

TEST_CASE("rows of every length up to two packs: padding adds nothing") {
  for (std::size_t n = 0; n <= 17; ++n) {
    CAPTURE(n);
    Row<2> flat = row_of<2>(n);
    check_against_plain<2>(flat.centre, {&flat.neighbours}, SmoothingKernel::wendland_c2, 0.3);
    Row<3> solid = row_of<3>(n);
    check_against_plain<3>(solid.centre, {&solid.neighbours}, SmoothingKernel::cubic_spline, 0.3);
    Counter op;
    testing::run(op, solid.centre, {&solid.neighbours}, {.smoothing_length = 0.3});
    CHECK(solid.centre["count"][0] == static_cast<double>(n));
  }
}

TEST_CASE("what stands in the padding of a row is never added, not even a NaN") {
  // A row's padding repeats its last neighbour, so the sums are right only if those lanes are left out.
  Row<3> row = row_of<3>(9);
  row.neighbours.set("weight", 1.0);
  Everything op;
  testing::run(op, row.centre, {&row.neighbours}, {.smoothing_length = 0.3});
  const double nine = row.centre["number"][0];
  CHECK(std::isfinite(nine));
  row.neighbours["weight"][8] = not_a_number;
  testing::run(op, row.centre, {&row.neighbours}, {.smoothing_length = 0.3});
  CHECK(std::isnan(row.centre["number"][0]));  // a true neighbour's NaN is seen
}

TEST_CASE("coincident particles exert no direction, and no NaN") {
  for (const bool scalar : {false, true}) {
    Body pair(3, {0.5, 0.5, 0.5, 0.5, 0.5, 0.5});
    pair.set("weight", 2.0);
    pair.set_each("velocity", 3, [](std::size_t i, std::size_t) { return static_cast<double>(i); });
    pair.set_each("gradient", 9, [](std::size_t, std::size_t) { return 1.0; });
    for (std::size_t k = 0; k < smoothing_kernel_names.size(); ++k) {
      CAPTURE(smoothing_kernel_names[k]);
      const auto kind = static_cast<SmoothingKernel>(k);
      Everything op;
      testing::run(op, pair, {&pair}, {.smoothing_length = 0.1, .smoothing_kernel = kind, .scalar = scalar});
      const double w0 = with_kernel<3>(kind, 0.1, [](const auto& kernel) { return kernel.w(0.0); });
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(pair["number"][i] == doctest::Approx(2.0 * w0).epsilon(1e-14));
        CHECK(op.self_W() == w0);
        for (std::size_t a = 0; a < 3; ++a) CHECK(pair["vector"][3 * i + a] == 0.0);
        for (std::size_t a = 0; a < 9; ++a) CHECK(std::isfinite(pair["matrix"][9 * i + a]));
      }
    }
  }
}

TEST_CASE("particles without neighbours are passed over if the operator says so, else get an empty sum") {
  Body own(2, {0, 0, 5, 5, 0.1, 0});
  Body other(2, {0, 0.1});
  for (const bool scalar : {false, true}) {
    own.set("count", -1.0);
    LonelyCounter skips;
    testing::run(skips, own, {&other}, {.smoothing_length = 0.1, .scalar = scalar});
    CHECK(own["count"] == std::vector<double>{1, -1, 1});
    own.set("count", -1.0);
    Counter counts;
    testing::run(counts, own, {&other}, {.smoothing_length = 0.1, .scalar = scalar});
    CHECK(own["count"] == std::vector<double>{1, 0, 1});
  }
}

TEST_CASE("reductions and accumulation over two chunks") {
  Body body(2, std::vector<double>(14, 0.0));
  body["value"] = {3, -7, 2.5, 11, 0, -1, 4};
  body["added"] = std::vector<double>(14, 100.0);
  Statistics op;
  testing::run(op, body, {}, {.smoothing_length = 0.1});
  CHECK(op.total.result() == 12.5);
  CHECK(op.seen == 12.5);
  CHECK(op.least.result() == -7.0);
  CHECK(op.largest.result() == 11.0);
  for (std::size_t i = 0; i < 7; ++i) {
    CHECK(body["added"][2 * i] == 100.0 + body["value"][i]);
    CHECK(body["added"][2 * i + 1] == 100.0);
  }
}

TEST_CASE("a reduction over nothing is its identity, and a NaN anywhere is seen") {
  Statistics op;
  Body empty(2, {});
  testing::run(op, empty, {}, {.smoothing_length = 0.1});
  CHECK(op.total.result() == 0.0);
  CHECK(op.least.result() == std::numeric_limits<double>::infinity());
  CHECK(op.largest.result() == -std::numeric_limits<double>::infinity());
  for (std::size_t at = 0; at < 5; ++at) {
    CAPTURE(at);
    Body body(2, std::vector<double>(10, 0.0));
    body["value"] = {1, 2, 3, 4, 5};
    body["value"][at] = not_a_number;
    testing::run(op, body, {}, {.smoothing_length = 0.1});
    CHECK(std::isnan(op.total.result()));
    CHECK(std::isnan(op.least.result()));
    CHECK(std::isnan(op.largest.result()));
  }
}

namespace {

// An operator's callbacks, bound to a body by hand.
template <class Op>
struct Described {
  explicit Described(Body& body) : body_(body) {
    auto attached = std::make_unique<impl::AttachedOperator<Op>>();
    attached->name = "test.operator";
    attached->op.set_dimensions(body.dimensions());
    c = impl::describe(std::move(attached), 0);
    for (std::uint32_t a = 0; a < c.n_accesses; ++a)
      views_.push_back(
          {sizeof(shoal_field), 1, body.data(c.accesses[a].field, 1), body.size(), body.size(), nullptr});
    const shoal_binding binding{sizeof(shoal_binding), body.dimensions(), body.size(),
                                views_.data(),         nullptr,           nullptr};
    CHECK(c.bind(c.self, &binding) == SHOAL_OK);
    step.size = sizeof step;
    step.dimensions = body.dimensions();
  }
  ~Described() { c.destroy(c.self); }
  Described(const Described&) = delete;
  Described& operator=(const Described&) = delete;
  double time_step() {
    const shoal_chunk chunk{sizeof(shoal_chunk), 0, 0, body_.size(), nullptr};
    return c.time_step(c.self, &step, &chunk);
  }
  shoal_operator c{};
  shoal_step step{};

 private:
  Body& body_;
  std::vector<shoal_field> views_;
};

}  // namespace

TEST_CASE("the time step of particles is the smallest, and a NaN anywhere is the result") {
  Body body(2, std::vector<double>(10, 0.0));
  body["limit"] = {5, 3, 4, 9, 6};
  {
    Described<LimitedStep> op(body);
    CHECK((op.c.flags & SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES) != 0);
    CHECK(op.time_step() == 3.0);
  }
  for (std::size_t at = 0; at < 5; ++at) {
    CAPTURE(at);
    body["limit"] = {5, 3, 4, 9, 6};
    body["limit"][at] = not_a_number;
    Described<LimitedStep> op(body);
    CHECK(std::isnan(op.time_step()));
  }
}

TEST_CASE("accesses say what is read of whom") {
  struct Accesses : PairOperator<Accesses> {
    In<Scalar> both{"both", unit("m"), doc("Both.")};
    In<Scalar> own{"own", own_only};
    In<Scalar> theirs{"theirs", neighbours_only};
    Out<Vector> written{"written", derived};
    InOut<Matrix> changed{"changed"};
    Accumulate<Vector> added{"added"};
    In<Integer> whole{"whole", own_only};
  } op;
  op.added.rename("load");
  const auto accesses = op.accesses();
  REQUIRE(accesses.size() == 8);
  struct Expected {
    std::string field;
    std::uint32_t mode, rank, type;
  };
  const std::vector<Expected> expected{
      {"position", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR, SHOAL_DOUBLE},
      {"both", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_SCALAR, SHOAL_DOUBLE},
      {"own", SHOAL_READ, SHOAL_SCALAR, SHOAL_DOUBLE},
      {"theirs", SHOAL_READ | SHOAL_OF_NEIGHBOURS | SHOAL_NOT_OWN, SHOAL_SCALAR, SHOAL_DOUBLE},
      {"written", SHOAL_WRITE | SHOAL_DERIVED, SHOAL_RANK_VECTOR, SHOAL_DOUBLE},
      {"changed", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_MATRIX, SHOAL_DOUBLE},
      {"load", SHOAL_ACCUMULATE, SHOAL_RANK_VECTOR, SHOAL_DOUBLE},
      {"whole", SHOAL_READ, SHOAL_SCALAR, SHOAL_INT64}};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(expected[k].field);
    CHECK(std::string(accesses[k].field) == expected[k].field);
    CHECK(accesses[k].mode == expected[k].mode);
    CHECK(accesses[k].rank == expected[k].rank);
    CHECK(accesses[k].data_type == expected[k].type);
    CHECK(accesses[k].size == sizeof(shoal_access));
  }
  CHECK(std::string(accesses[1].unit) == "m");
  CHECK(std::string(accesses[1].doc) == "Both.");
  CHECK(accesses[2].unit == nullptr);
}

TEST_CASE("fields of particle operators are read of nobody else") {
  struct Reads : ParticleOperator<Reads> {
    In<Scalar> value{"value"};
  } op;
  REQUIRE(op.accesses().size() == 1);
  CHECK(op.accesses()[0].mode == SHOAL_READ);
}
