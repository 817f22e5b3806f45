// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Booleans, shells and transforms.
#include <numbers>
#include <stdexcept>

#include "support.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::test;

namespace {

ShapePtr disc(double x, double y, double radius) {
  return std::make_shared<Ball>(Ball::Parameters{{x, y, 0}, radius});
}
ShapePtr rectangle(double x0, double y0, double x1, double y1) {
  return std::make_shared<BoxShape>(BoxShape::Parameters{{x0, y0, 0}, {x1, y1, 0}, 2});
}
std::vector<Point> sample_circle(double x, double y, double radius, int count) {
  std::vector<Point> samples;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    samples.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle), 0});
  }
  return samples;
}
std::vector<Point> kept(const std::vector<Point>& samples, auto predicate) {
  std::vector<Point> out;
  for (const Point& p : samples) {
    if (predicate(p)) out.push_back(p);
  }
  return out;
}
void append(std::vector<Point>& to, const std::vector<Point>& from) {
  to.insert(to.end(), from.begin(), from.end());
}
std::vector<Point> outline(double x0, double y0, double x1, double y1, int count = 2000) {
  return sample_polygon({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, count);
}

}  // namespace

TEST_CASE("union, intersection and difference of two discs") {
  const ShapePtr a = disc(0, 0, 1);
  const ShapePtr b = disc(1.2, 0.3, 0.8);
  const auto in_a = [](const Point& p) { return std::hypot(p[0], p[1]) < 1; };
  const auto in_b = [](const Point& p) { return std::hypot(p[0] - 1.2, p[1] - 0.3) < 0.8; };
  const auto circle_a = sample_circle(0, 0, 1, 8000);
  const auto circle_b = sample_circle(1.2, 0.3, 0.8, 8000);
  const auto where = random_points(500, {-1.5, -1.5, 0}, {2.5, 1.5, 0});

  auto surface = kept(circle_a, [&](const Point& p) { return !in_b(p); });
  append(surface, kept(circle_b, [&](const Point& p) { return !in_a(p); }));
  const Union both({{a, b}});
  check_bound(both, surface, where, [&](const Point& p) { return in_a(p) || in_b(p); });
  for (const Point& p : where) {  // exact outside
    if (!in_a(p) && !in_b(p))
      CHECK(both.signed_distance(p) == doctest::Approx(brute_distance(surface, p)).epsilon(1e-3));
  }
  check_normals(both, where);
  check_lipschitz(both, where);
  CHECK_FALSE(both.distance_is_exact());
  CHECK(both.bounds().lower[0] == -1.0);
  CHECK(both.bounds().upper[0] == 2.0);

  surface = kept(circle_a, in_b);
  append(surface, kept(circle_b, in_a));
  const Intersection common({{a, b}});
  check_bound(common, surface, where, [&](const Point& p) { return in_a(p) && in_b(p); });
  for (const Point& p : where) {  // exact inside
    if (in_a(p) && in_b(p))
      CHECK(-common.signed_distance(p) == doctest::Approx(brute_distance(surface, p)).epsilon(1e-3));
  }
  check_normals(common, where);
  check_lipschitz(common, where);
  CHECK(common.bounds().lower[0] == doctest::Approx(0.4));
  CHECK(common.bounds().upper[0] == 1.0);

  surface = kept(circle_a, [&](const Point& p) { return !in_b(p); });
  append(surface, kept(circle_b, in_a));
  const Difference without({a, b});
  check_bound(without, surface, where, [&](const Point& p) { return in_a(p) && !in_b(p); });
  check_normals(without, where);
  check_lipschitz(without, where);
}

TEST_CASE("what a difference removes is exactly what the removed shape holds") {
  const ShapePtr outer = rectangle(-1, -1, 2, 2);
  const ShapePtr inner = rectangle(0, 0, 1, 1);
  const Difference rest({outer, inner});
  for (int i = -10; i < 20; ++i) {
    for (int j = -10; j < 20; ++j) {  // lattice points on the faces of both
      const Point p{0.1 * i, 0.1 * j, 0};
      CHECK((rest.contains(p, 1e-7) != inner->contains(p, 1e-7)));
    }
  }
}

TEST_CASE("shell of a box: sharp corners, exact distance") {
  const ShapePtr box = rectangle(0, 0, 2, 1);
  const Shell shell({box, 0.3});
  auto surface = outline(0, 0, 2, 1);
  append(surface, outline(-0.3, -0.3, 2.3, 1.3));
  const auto in = [](const Point& p) {
    const bool outer = p[0] > -0.3 && p[0] < 2.3 && p[1] > -0.3 && p[1] < 1.3;
    const bool inner = p[0] > 0 && p[0] < 2 && p[1] > 0 && p[1] < 1;
    return outer && !inner;
  };
  const auto where = random_points(500, {-0.8, -0.8, 0}, {2.8, 1.8, 0});
  check_exact_distance(shell, surface, 0.7e-3, where, in);
  check_normals(shell, where);
  check_lipschitz(shell, where);
  CHECK(shell.contains({-0.29, -0.29, 0}));  // beyond the Euclidean reach of the corner
  CHECK(shell.distance_is_exact());

  const Shell within({box, 0.3, Shell::Placement::inside});
  auto surface_within = outline(0, 0, 2, 1);
  append(surface_within, outline(0.3, 0.3, 1.7, 0.7));
  check_exact_distance(within, surface_within, 0.6e-3, where, [](const Point& p) {
    const bool outer = p[0] > 0 && p[0] < 2 && p[1] > 0 && p[1] < 1;
    return outer && !(p[0] > 0.3 && p[0] < 1.7 && p[1] > 0.3 && p[1] < 0.7);
  });

  const Shell across({box, 0.3, Shell::Placement::centred});
  CHECK(across.signed_distance({0, 0.5, 0}) == doctest::Approx(-0.15));
  CHECK(across.signed_distance({-0.15, 0.5, 0}) == doctest::Approx(0.0));
  CHECK(across.contains({-0.149, -0.149, 0}));
}

TEST_CASE("shell of other shapes: distance exact where theirs is") {
  const std::vector<Point> vertices{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {1, 0.8, 0}, {0, 2, 0}};
  const ShapePtr polygon = std::make_shared<Polygon>(Polygon::Parameters{vertices});
  const Shell shell({polygon, 0.25});
  const auto where = random_points(400, {-1, -1, 0}, {4, 3, 0});
  check_lipschitz(shell, where);
  check_normals(shell, where);
  for (const Point& p : where) {
    const double d = polygon->signed_distance(p);
    CHECK(shell.signed_distance(p) == doctest::Approx(std::abs(d - 0.125) - 0.125));
  }
  const Shell ring({disc(0, 0, 1), 0.2, Shell::Placement::inside});
  CHECK(ring.signed_distance({0.9, 0, 0}) == doctest::Approx(-0.1));
  CHECK(ring.signed_distance({0.5, 0, 0}) == doctest::Approx(0.3));
  CHECK(ring.signed_distance({1.5, 0, 0}) == doctest::Approx(0.5));
  CHECK(ring.normal({0.85, 0, 0})[0] == doctest::Approx(-1.0));

  const ShapePtr can = std::make_shared<Cylinder>(Cylinder::Parameters{{0, 0, 0}, {0, 0, 2}, 0.5});
  const Shell walls({can, 0.1});
  CHECK(walls.contains({0.59, 0, -0.09}));  // the rim is sharp
  CHECK(walls.signed_distance({0.7, 0, 2.2}) == doctest::Approx(std::hypot(0.1, 0.1)));
}

TEST_CASE("the face of a shell is the surface that it lines") {
  const ShapePtr box = rectangle(0, 0, 2, 1);
  const Shell tank({box, 0.4});
  const Face back = tank.face({1, -0.35, 0});  // nearer to the back of the wall
  CHECK(back.distance == doctest::Approx(-0.35));
  CHECK(back.normal[1] == doctest::Approx(1.0));  // into the tank
  CHECK(tank.normal({1, -0.35, 0})[1] == doctest::Approx(-1.0));
  const Face corner = tank.face({-0.1, -0.1, 0});
  CHECK(corner.distance == doctest::Approx(-0.1 * std::numbers::sqrt2));
  CHECK(corner.normal[0] == doctest::Approx(std::numbers::sqrt2 / 2));
  const Shell lining({box, 0.4, Shell::Placement::inside});
  CHECK(lining.face({1, 0.35, 0}).normal[1] == doctest::Approx(-1.0));
  CHECK(lining.face({1, 0.35, 0}).distance == doctest::Approx(-0.35));

  // Through booleans and transforms: a tank with an obstacle, open at the top, turned by a quarter.
  const ShapePtr wall = std::make_shared<Shell>(Shell::Parameters{box, 0.4});
  const ShapePtr open = std::make_shared<Difference>(Difference::Parameters{wall, rectangle(-1, 1, 3, 2)});
  const ShapePtr scene = std::make_shared<Union>(Union::Parameters{{open, disc(1, 0.5, 0.1)}});
  CHECK(scene->face({1, -0.35, 0}).normal[1] == doctest::Approx(1.0));
  CHECK(scene->face({1.05, 0.5, 0}).normal[0] == doctest::Approx(1.0));
  CHECK(scene->face({1.05, 0.5, 0}).distance == doctest::Approx(-0.05));
  const Transform turned({.of = scene, .angle = std::numbers::pi / 2, .dimension = 2});
  CHECK(turned.face({0.35, 1, 0}).normal[0] == doctest::Approx(-1.0));
  CHECK(turned.face({0.35, 1, 0}).distance == doctest::Approx(-0.35));
}

TEST_CASE("transform: a turned, scaled and moved box in 2D has an exact distance") {
  const ShapePtr box = rectangle(0, 0, 2, 1);
  const Transform moved({.of = box,
                         .scale = {1.5, 1.5, 1},
                         .angle = 0.4,
                         .centre = {1, 0, 0},
                         .translation = {0.2, -0.3, 0},
                         .dimension = 2});
  const auto place = [](Point p) {
    const double x = 1.5 * (p[0] - 1);
    const double y = 1.5 * p[1];
    return Point{1 + x * std::cos(0.4) - y * std::sin(0.4) + 0.2, x * std::sin(0.4) + y * std::cos(0.4) - 0.3,
                 0};
  };
  auto surface = outline(0, 0, 2, 1, 4000);
  for (Point& p : surface) p = place(p);
  const auto where = random_points(400, {-2, -2, 0}, {4, 3, 0});
  check_exact_distance(moved, surface, 0.5e-3, where, [&](const Point& p) {
    const double x = p[0] - 1.2;
    const double y = p[1] + 0.3;
    const double u = 1 + (x * std::cos(0.4) + y * std::sin(0.4)) / 1.5;
    const double v = (-x * std::sin(0.4) + y * std::cos(0.4)) / 1.5;
    return u > 0 && u < 2 && v > 0 && v < 1;
  });
  check_normals(moved, where);
  check_lipschitz(moved, where);
  CHECK(moved.distance_is_exact());
  // A shell around it is sharp as well: the grown box's corner, moved.
  const Shell shell(
      {std::make_shared<Transform>(Transform::Parameters{.of = box, .angle = 0.4, .dimension = 2}), 0.3});
  const Point tip{-0.29 * std::cos(0.4) + 0.29 * std::sin(0.4), -0.29 * std::sin(0.4) - 0.29 * std::cos(0.4),
                  0};
  CHECK(shell.contains(tip));
}

TEST_CASE("transform in 3D: about a slanted axis, bounds, and unequal scales as a bound") {
  const ShapePtr box = std::make_shared<BoxShape>(BoxShape::Parameters{{0, 0, 0}, {1, 2, 3}, 3});
  // A third of a turn about (1,1,1) sends x to y to z to x.
  const Transform turned({.of = box, .axis = {1, 1, 1}, .angle = 2.0 * std::numbers::pi / 3.0});
  const Box bounds = turned.bounds();
  CHECK(bounds.upper[0] == doctest::Approx(3.0));
  CHECK(bounds.upper[1] == doctest::Approx(1.0));
  CHECK(bounds.upper[2] == doctest::Approx(2.0));
  CHECK(std::abs(bounds.lower[0]) < 1e-12);
  CHECK(turned.signed_distance({2.9, 0.5, 1}) == doctest::Approx(-0.1));
  CHECK(turned.signed_distance({3.2, 0.5, 1}) == doctest::Approx(0.2));
  const auto where = random_points(200, {-1, -1, -1}, {4, 4, 4});
  check_normals(turned, where);

  const Transform ellipse({.of = disc(0, 0, 1), .scale = {2, 0.5, 1}, .dimension = 2});
  std::vector<Point> surface = sample_circle(0, 0, 1, 20000);
  for (Point& p : surface) p = {2 * p[0], 0.5 * p[1], 0};
  const auto around = random_points(300, {-3, -1, 0}, {3, 1, 0});
  check_bound(ellipse, surface, around, [](const Point& p) { return p[0] * p[0] / 4 + p[1] * p[1] * 4 < 1; });
  check_lipschitz(ellipse, around);
  CHECK_FALSE(ellipse.distance_is_exact());
  // On the surface the normal is that of the ellipse.
  const Point n = ellipse.normal({2 * std::cos(0.7), 0.5 * std::sin(0.7), 0});
  const Point expected = point::unit({std::cos(0.7) / 2, std::sin(0.7) / 0.5, 0}, {});
  CHECK(point::length(point::minus(n, expected)) < 1e-12);
}

TEST_CASE("transform: quarter turns keep infinite sides apart from finite ones") {
  const ShapePtr strip =
      std::make_shared<BoxShape>(BoxShape::Parameters{{-infinity, 0, 0}, {infinity, 1, 0}, 2});
  const Transform upright({.of = strip, .angle = std::numbers::pi / 2, .dimension = 2});
  const Box bounds = upright.bounds();
  CHECK(bounds.lower[0] == doctest::Approx(-1.0));
  CHECK(std::abs(bounds.upper[0]) < 1e-15);
  CHECK(std::isinf(bounds.lower[1]));
  CHECK(std::isinf(bounds.upper[1]));
}

TEST_CASE("composites refuse what they cannot be") {
  using Bad = std::invalid_argument;
  const ShapePtr box = rectangle(0, 0, 2, 1);
  CHECK(refusal<Bad>([] { return Union(Union::Parameters{}).bounds(); }) ==
        "a union needs at least one shape");
  CHECK(refusal<Bad>([&] {
          return Intersection({{box, nullptr}}).bounds();
        }) == "a shape of an intersection is missing");
  CHECK(refusal<Bad>([&] {
          return Difference({box, nullptr}).bounds();
        }) == "a shape of a difference is missing");
  CHECK(refusal<Bad>([&] { return Shell({nullptr, 1}).bounds(); }) == "a shape of a shell is missing");
  CHECK(refusal<Bad>([&] {
          return Shell({box, 0}).bounds();
        }) == "the thickness of a shell must be positive, but is 0");
  CHECK(refusal<Bad>([&] {
          return Shell({box, 0.5, Shell::Placement::inside}).bounds();
        }) ==
        "a box of side 1 along y leaves nothing when it shrinks by 0.5 on each side; take a smaller "
        "thickness, or the "
        "box itself");
  CHECK(
      refusal<Bad>([] {
        return Shell({disc(0, 0, 1), 1, Shell::Placement::inside}).bounds();
      }) ==
      "a ball of radius 1 leaves nothing when it shrinks by 1; take a smaller thickness, or the ball itself");
  CHECK(refusal<Bad>([&] {
          return Transform({.of = box, .scale = {1, 0, 1}}).bounds();
        }) == "the scales of a transform must be positive, but are (1, 0, 1)");
  CHECK(refusal<Bad>([&] {
          return Transform({.of = box, .axis = {0, 0, 0}}).bounds();
        }) == "the axis of a rotation must be a finite vector other than zero");
  CHECK(refusal<Bad>([&] {
          return Transform({.of = box, .axis = {1, 0, 0}, .dimension = 2}).bounds();
        }) == "in two dimensions a shape turns about z only; leave the axis out, or make it (0, 0, 1)");
  CHECK(refusal<Bad>([&] { return Transform({.of = nullptr}).bounds(); }) ==
        "there is no shape to transform");
}
