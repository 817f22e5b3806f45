// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Lattice filling: exact counts at awkward spacings, against a point-by-point search, and refusals.
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "kernel/geometry/generator.hpp"
#include "support.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::test;

namespace {

ShapePtr rectangle(double x0, double y0, double x1, double y1) {
  return std::make_shared<BoxShape>(BoxShape::Parameters{{x0, y0, 0}, {x1, y1, 0}, 2});
}
ShapePtr brick(const Point& lower, const Point& upper) {
  return std::make_shared<BoxShape>(BoxShape::Parameters{lower, upper, 3});
}

/// Every lattice point of a generous cube of indices, asked one by one.
std::vector<Point> search(const Shape& shape, double s, int dimension, const Point& origin, int reach) {
  std::vector<Point> found;
  const int deep = dimension == 3 ? reach : 0;
  for (int k = -deep; k <= deep; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        Point p{std::fma(i + 0.5, s, origin[0]), std::fma(j + 0.5, s, origin[1]), 0};
        if (dimension == 3) p[2] = std::fma(k + 0.5, s, origin[2]);
        if (shape.contains(p, 1e-6 * s)) found.push_back(p);
      }
    }
  }
  return found;
}

double closest(const std::vector<Point>& points) {
  double least = infinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, point::length(point::minus(points[i], points[j])));
  }
  return least;
}

}  // namespace

TEST_CASE("lattice: boxes of whole numbers of spacings give exactly their count, at any spacing and origin") {
  CHECK(fill_lattice(*rectangle(0, 0, 1, 1), 0.1, 2).size() == 100);
  CHECK(fill_lattice(*rectangle(0, 0, 1, 1), 0.025, 2).size() == 1600);
  CHECK(fill_lattice(*rectangle(0, 0, 1, 1), 1.0 / 3.0, 2).size() == 9);
  CHECK(fill_lattice(*rectangle(0, 0, 2, 1), 0.025, 2).size() == 3200);
  CHECK(fill_lattice(*brick({0, 0, 0}, {1, 1, 1}), 0.1, 3).size() == 1000);
  CHECK(fill_lattice(*brick({0, 0, 0}, {1, 1, 1}), 1.0 / 3.0, 3).size() == 27);
  CHECK(fill_lattice(*brick({-0.3, 0.1, 1e3}, {0.4, 0.7, 1e3 + 0.5}), 0.05, 3).size() == 14 * 12 * 10);
  for (int n = 1; n <= 120; ++n) {
    const double s = 1.0 / n;
    CAPTURE(n);
    CHECK(fill_lattice(*rectangle(0, 0, 1, 1), s, 2).size() == static_cast<std::size_t>(n * n));
    // Faces right through particle centres, where rounding would decide without the tolerance.
    CHECK(fill_lattice(*rectangle(0, 0, 1, 1), s, 2, {.origin = {0.5 * s, 0.5 * s, 0}}).size() ==
          static_cast<std::size_t>(n * n));
    // Sides made of sums that do not round to what they should be.
    double upper = 0.0;
    for (int i = 0; i < n; ++i) upper += s;
    CHECK(fill_lattice(*rectangle(0.7, -3.1, 0.7 + upper, -3.1 + upper), s, 2, {.origin = {0.7, -3.1, 0}})
              .size() == static_cast<std::size_t>(n * n));
    CHECK(fill_lattice(*rectangle(100, 0, 101, 1), s, 2, {.origin = {0.5 * s, 0.5 * s, 0}}).size() ==
          static_cast<std::size_t>(n * n));
  }
}

TEST_CASE("lattice: centres stand where they should, in order z, y, x") {
  const auto points = fill_lattice(*brick({0, 0, 0}, {1, 1, 1}), 0.5, 3);
  REQUIRE(points.size() == 8);
  CHECK(points[0] == Point{0.25, 0.25, 0.25});
  CHECK(points[1] == Point{0.75, 0.25, 0.25});
  CHECK(points[2] == Point{0.25, 0.75, 0.25});
  CHECK(points[4] == Point{0.25, 0.25, 0.75});
  const auto shifted = fill_lattice(*rectangle(0, 0, 1, 1), 0.5, 2, {.origin = {0.1, 0, 0}});
  REQUIRE(shifted.size() == 4);
  CHECK(shifted[0][0] == doctest::Approx(0.35));
  CHECK(shifted[0][2] == 0.0);
  CHECK(lattice_volume(0.5, 2) == 0.25);
  CHECK(lattice_volume(0.5, 3) == 0.125);
}

TEST_CASE("lattice: a wall and what it encloses tile the plane") {
  for (const double s : {0.1, 0.025, 1.0 / 3.0, 0.07}) {
    const ShapePtr inner = rectangle(0, 0, 20 * s, 10 * s);
    const Shell tank({inner, 4 * s});
    for (const double shift : {0.0, 0.5}) {  // half a cell: faces through centres
      const LatticeOptions options{.origin = {shift * s, shift * s, 0}};
      const auto wall = fill_lattice(tank, s, 2, options);
      const auto within = fill_lattice(*inner, s, 2, options);
      CHECK(within.size() == 200);
      CHECK(wall.size() == 28 * 18 - 200);  // corners full
      std::vector<Point> all = wall;
      all.insert(all.end(), within.begin(), within.end());
      CHECK(closest(all) > 0.999 * s);
    }
  }
  // In 3D, and around a polygon, where flat sides have exactly their rows too.
  const double s = 0.05;
  const Shell tank({brick({0, 0, 0}, {0.5, 0.4, 0.3}), 3 * s});
  CHECK(fill_lattice(tank, s, 3).size() == 16 * 14 * 12 - 10 * 8 * 6);
  const ShapePtr square =
      std::make_shared<Polygon>(Polygon::Parameters{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  const Shell around({square, 3 * s});
  for (const double shift : {0.0, 0.5}) {
    int left = 0;
    int right = 0;
    for (const Point& p : fill_lattice(around, s, 2, {.origin = {shift * s, shift * s, 0}})) {
      if (std::abs(p[1] - 0.5) > 0.49 * s + 1e-9 && std::abs(p[1] - 0.5 - 0.5 * s) > 1e-9) continue;
      ++(p[0] < 0.5 ? left : right);
    }
    CHECK(left == 3);
    CHECK(right == 3);
  }
}

TEST_CASE("lattice: strides find the same points, in the same order, as asking each") {
  const ShapePtr polygon = std::make_shared<Polygon>(
      Polygon::Parameters{{{-1, -1, 0}, {1.3, -0.8, 0}, {0.2, 0.1, 0}, {1.1, 1.2, 0}, {-0.9, 0.4, 0}}});
  const ShapePtr disc = std::make_shared<Ball>(Ball::Parameters{{0.1, 0.2, 0}, 0.9});
  const std::vector<ShapePtr> flat{
      polygon,
      disc,
      std::make_shared<Shell>(Shell::Parameters{polygon, 0.2}),
      std::make_shared<Difference>(Difference::Parameters{disc, rectangle(0, 0, 0.5, 0.5)}),
      std::make_shared<Union>(Union::Parameters{{disc, rectangle(-1.2, -1.1, 0, 0)}}),
      std::make_shared<Intersection>(Intersection::Parameters{{disc, polygon}}),
      std::make_shared<Transform>(
          Transform::Parameters{.of = disc, .scale = {1.2, 0.3, 1}, .angle = 0.5, .dimension = 2}),
  };
  for (const ShapePtr& shape : flat) {
    for (const Point& origin : {Point{0, 0, 0}, Point{0.013, -0.02, 0}}) {
      const auto expected = search(*shape, 0.05, 2, origin, 40);
      CHECK(expected.size() > 100);
      CHECK(fill_lattice(*shape, 0.05, 2, {.origin = origin}) == expected);
    }
  }
  const ShapePtr can =
      std::make_shared<Cylinder>(Cylinder::Parameters{{-0.5, -0.4, -0.6}, {0.6, 0.5, 0.3}, 0.4});
  const std::vector<ShapePtr> solid{
      can, std::make_shared<Shell>(Shell::Parameters{can, 0.12}),
      std::make_shared<Shell>(Shell::Parameters{brick({-.5, -.4, -.3}, {.5, .4, .3}), 0.2})};
  for (const ShapePtr& shape : solid) {
    const auto expected = search(*shape, 0.06, 3, {}, 20);
    CHECK(expected.size() > 500);
    CHECK(fill_lattice(*shape, 0.06, 3) == expected);
  }
}

TEST_CASE("lattice: volumes converge, and the estimate agrees") {
  const Ball ball({{0, 0, 0}, 1.0});
  const double s = 0.04;
  const double volume = 4.0 / 3.0 * std::numbers::pi;
  const double count = static_cast<double>(fill_lattice(ball, s, 3).size());
  CHECK(count * lattice_volume(s, 3) == doctest::Approx(volume).epsilon(0.005));
  CHECK(estimate_count(ball, s, 3) == doctest::Approx(volume / (s * s * s)).epsilon(0.01));
  CHECK(estimate_count(ball, 0.01, 2) == doctest::Approx(std::numbers::pi / 1e-4).epsilon(0.002));
  const Shell tank({brick({0, 0, 0}, {1, 1, 1}), 0.04});
  CHECK(estimate_count(tank, 0.01, 3) == doctest::Approx(108.0 * 108 * 108 - 1e6).epsilon(0.02));
  CHECK(estimate_count(*rectangle(0, 0, 1, 1), 0.1, 2) == doctest::Approx(100.0).epsilon(0.001));
  const Shell thin({brick({0, 0, 0}, {3.22, 1, 1}), 0.02});  // thinner than a cell of the integral
  const double exact = 3.26 * 1.04 * 1.04 - 3.22;
  CHECK(estimate_count(thin, 0.005, 3) * lattice_volume(0.005, 3) == doctest::Approx(exact).epsilon(0.01));
}

TEST_CASE("lattice: hexagonal and close packed have the same volume per particle and more distance") {
  const double s = 0.05;
  const LatticeOptions hexagonal{.kind = Lattice::hexagonal};
  const auto flat = fill_lattice(*rectangle(0, 0, 3, 3), s, 2, hexagonal);
  CHECK(static_cast<double>(flat.size()) * lattice_volume(s, 2) == doctest::Approx(9.0).epsilon(0.03));
  CHECK(closest(flat) == doctest::Approx(s * std::sqrt(2.0 / std::sqrt(3.0))));
  const auto solid = fill_lattice(*brick({0, 0, 0}, {0.8, 0.8, 0.8}), s, 3, hexagonal);
  CHECK(static_cast<double>(solid.size()) * lattice_volume(s, 3) == doctest::Approx(0.512).epsilon(0.04));
  CHECK(closest(solid) == doctest::Approx(s * std::pow(2.0, 1.0 / 6.0)));
  // Each particle amid the lattice has 12 nearest neighbours: close packing, not merely stacked layers.
  const Point middle{0.4, 0.4, 0.4};
  std::size_t central = 0;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    if (point::length(point::minus(solid[i], middle)) < point::length(point::minus(solid[central], middle)))
      central = i;
  }
  int neighbours = 0;
  for (const Point& p : solid) {
    const double r = point::length(point::minus(p, solid[central]));
    if (r > 0 && r < 1.01 * s * std::pow(2.0, 1.0 / 6.0)) ++neighbours;
  }
  CHECK(neighbours == 12);
}

TEST_CASE("lattice: refuses what is unbounded, meaningless or too large, in words") {
  using Bad = std::invalid_argument;
  using Large = std::length_error;
  const HalfSpace floor({{0, 0, 0}, {0, 1, 0}});
  CHECK(refusal<Bad>([&] { return fill_lattice(floor, 0.1, 2); }) ==
        "a shape that does not end along x cannot be filled with particles; intersect it with a box");
  CHECK(refusal<Bad>([&] { return fill_lattice(*rectangle(0, 0, 1, 1), 0.1, 3); }) ==
        "a shape that does not end along z cannot be filled with particles; intersect it with a box");
  const Cylinder can({{0, 0, 0}, {1, 0, 0}, 0.1});
  CHECK(refusal<Bad>([&] { return fill_lattice(can, 0.1, 2); }) ==
        "this shape has no meaning in 2 dimensions");
  CHECK(refusal<Bad>([&] { return fill_lattice(can, 0, 3); }) ==
        "the particle spacing must be positive, but is 0");
  CHECK(refusal<Bad>([&] { return fill_lattice(can, 0.1, 1); }) == "particles fill 2 or 3 dimensions, not 1");

  const auto square = rectangle(0, 0, 1, 1);
  CHECK(fill_lattice(*square, 0.1, 2, {.limit = 100}).size() == 100);
  const std::string few = refusal<Large>([&] { return fill_lattice(*square, 0.1, 2, {.limit = 99}); });
  CHECK(few.find("99") != std::string::npos);
  const std::string many = refusal<Large>([&] { return fill_lattice(*square, 1e-6, 2); });
  CHECK(many.find("1e+12 particles") != std::string::npos);
  CHECK(many.find("limit is 50000000") != std::string::npos);
  CHECK(!refusal<Large>([&] { return fill_lattice(*brick({0, 0, 0}, {1, 1, 1}), 1e-9, 3); }).empty());
  CHECK(!refusal<Large>([&] { return fill_lattice(*square, 1e-300, 2); }).empty());
  // Nothing to fill is no error: shapes that do not meet.
  const Intersection nothing({{rectangle(0, 0, 1, 1), rectangle(2, 2, 3, 3)}});
  CHECK(fill_lattice(nothing, 0.1, 2).empty());
}
