// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// An operator in single precision against itself in double: errors do not grow with the domain, nor with very small and
// very large particles.
#include "shoal/single_precision.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <random>
#include <tuple>

#include "shoal/pair_operator.hpp"
#include "shoal/testing.hpp"

using namespace shoal;

namespace {

// Everything that a pair may ask; `listed` and `other` differ only in that records hold the first.
struct Everything : PairOperator<Everything> {
  static constexpr bool single_in_3d_only = true;

  In<Scalar> volume{"volume"};
  In<Vector> listed{"velocity"};
  In<Scalar> pressure{"pressure"};
  In<Vector> other{"acceleration"};
  Out<Scalar> sum{"sum", unit("1"), doc("")};
  Out<Vector> force{"force", unit("1"), doc("")};
  Out<Matrix> gradient{"gradient", unit("1"), doc("")};

  std::shared_ptr<SinglePrecision> single;

  auto neighbour_fields() const { return std::tie(listed, pressure); }
  auto pair(const auto& p) const {
    const auto v = p.i(listed) - p.j(listed);
    return sums((p.j(volume) * p.W()) * dot(v, p.r_ij()),
                (p.weight(volume) * (p.i(pressure) + p.j(pressure))) * p.r_ij() +
                    (p.j(volume) * p.dW()) * (p.i(other) + p.j(other)),
                outer((p.j(volume) * p.dW_over_r()) * v, p.r_ij()));
  }
  void particle(auto i, double s, auto f, auto g) const {
    sum[i] = s;
    force[i] = f;
    gradient[i] = g;
  }
};

testing::Body cloud(double dx, double offset, std::uint64_t seed = 2) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> x;
  for (int a = 0; a < 7; ++a)
    for (int b = 0; b < 7; ++b)
      for (int c = 0; c < 7; ++c)
        for (const int k : {a, b, c}) x.push_back(offset + dx * (k + 0.2 * uniform(random)));
  testing::Body body(3, x);
  body.set_each("volume", 1, [&](auto, auto) { return dx * dx * dx * (1.0 + 0.1 * uniform(random)); });
  for (const char* field : {"velocity", "acceleration"})
    body.set_each(field, 3, [&](auto, auto) { return uniform(random); });
  body.set_each("pressure", 1, [&](auto, auto) { return 1.0 + 0.1 * uniform(random); });
  return body;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, size = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, std::abs(a[k] - b[k]));
    size = std::max(size, std::abs(b[k]));
  }
  return most / size;
}

void compare(testing::Body& body, const std::vector<testing::Body*>& neighbours, const testing::Setup& setup,
             double tolerance = 1e-6) {
  Everything in_single, in_double;
  in_single.single = std::make_shared<SinglePrecision>();
  testing::run(in_double, body, neighbours, setup);
  const auto sum = body["sum"], force = body["force"], gradient = body["gradient"];
  for (const char* field : {"sum", "force", "gradient"}) body[field].assign(body[field].size(), -1.0);
  testing::run(in_single, body, neighbours, setup);
  CHECK(largest_difference(body["sum"], sum) < tolerance);
  CHECK(largest_difference(body["force"], force) < tolerance);
  CHECK(largest_difference(body["gradient"], gradient) < tolerance);
}

}  // namespace

TEST_CASE("sums in single precision are those in double to rounding, for all smoothing kernels") {
  testing::Body body = cloud(0.1, 0.0);
  for (const std::string_view name : smoothing_kernel_names) {
    CAPTURE(name);
    compare(body, {&body}, {.smoothing_length = 0.13, .smoothing_kernel = *smoothing_kernel_from_name(name)},
            2e-6);
  }
}

TEST_CASE("their error is the same far from the origin and for particles of any size") {
  for (const double dx : {1e-6, 1e-3, 1.0, 1e4})
    for (const double offset : {0.0, 1e3 * dx, -1e6 * dx}) {
      CAPTURE(dx);
      CAPTURE(offset);
      testing::Body body = cloud(dx, offset);
      compare(body, {&body}, {.smoothing_length = 1.3 * dx});
    }
}

TEST_CASE("neighbours of several bodies count, and rows of any length") {
  testing::Body body = cloud(0.1, 0.0), other = cloud(0.1, 0.05, 7);
  for (const double h : {0.06, 0.09, 0.13, 0.2}) compare(body, {&body, &other}, {.smoothing_length = h});
  testing::Body lonely(3, {0.0, 0.0, 0.0});
  for (const char* field : {"volume", "pressure"}) lonely.set(field, 1.0);
  for (const char* field : {"velocity", "acceleration"})
    lonely.set_each(field, 3, [](auto, auto) { return 1.0; });
  Everything op;
  op.single = std::make_shared<SinglePrecision>();
  testing::run(op, lonely, {&lonely}, {.smoothing_length = 0.1});
  CHECK(lonely["sum"][0] == 0.0);
}

TEST_CASE("records that hold zeros only, and those of the particle itself, change nothing") {
  testing::Body body = cloud(0.1, 0.0), other = cloud(0.1, 0.05, 7);
  const testing::Setup setup{.smoothing_length = 0.13};
  compare(body, {&other, &body}, setup);
  compare(body, {&other}, setup);
  // Velocity and pressure share a record.
  for (double& v : other["velocity"]) v = 0.0;
  compare(body, {&other, &body}, setup);
  for (double& p : other["pressure"]) p = 0.0;
  compare(body, {&body, &other}, setup);
  other["pressure"].back() = 2.0;
  compare(body, {&body, &other}, setup);
  other["velocity"].back() = std::nan("");
  Everything op;
  op.single = std::make_shared<SinglePrecision>();
  testing::run(op, body, {&other}, setup);
  CHECK(std::isnan(body["sum"].back()));
}

TEST_CASE("coincident particles give no NaN, a NaN among the coordinates does") {
  testing::Body body = cloud(0.1, 0.0);
  for (std::size_t a = 0; a < 3; ++a) body["position"][a] = body["position"][3 + a];
  compare(body, {&body}, {.smoothing_length = 0.13});

  testing::Body broken = cloud(0.1, 0.0);
  testing::Setup setup{.smoothing_length = 0.13, .listed_at = broken["position"]};
  broken["position"][1] = std::nan("");
  Everything op;
  op.single = std::make_shared<SinglePrecision>();
  testing::run(op, broken, {&broken}, setup);
  CHECK(std::isnan(broken["sum"][1]));  // a neighbour of the first
  CHECK(!std::isnan(broken["sum"][342]));
}

TEST_CASE("records count once for operators that share them") {
  Everything first, second;
  first.single = second.single = std::make_shared<SinglePrecision>();
  for (Everything* op : {&first, &second}) op->set_dimensions(3);
  CHECK(first.bytes_per_particle() == 4 * (4 + 4));
  CHECK(second.bytes_per_particle() == 0);
  Everything alone;
  CHECK(alone.bytes_per_particle() == 0);
}
