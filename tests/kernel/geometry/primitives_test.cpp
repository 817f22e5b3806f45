// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Box, ball, cylinder and half space against dense samplings of their surfaces.
#include <numbers>
#include <stdexcept>

#include "support.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::test;

namespace {

const Point box_lower{-1.0, 0.5, 2.0};
const Point box_upper{1.5, 1.7, 3.1};

std::vector<Point> sample_cylinder(const Point& from, const Point& to, double radius, int around, int rings) {
  const Point axis = point::unit(point::minus(to, from), {});
  const Point helper = std::abs(axis[0]) < 0.5 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point u = point::unit(point::along(helper, -point::dot(helper, axis), axis), {});
  const Point v{axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2],
                axis[0] * u[1] - axis[1] * u[0]};
  std::vector<Point> samples;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / around;
    const Point ray = point::plus(point::times(std::cos(angle), u), point::times(std::sin(angle), v));
    for (const Point& end : {from, to}) sample_segment(samples, end, point::along(end, radius, ray), rings);
    sample_segment(samples, point::along(from, radius, ray), point::along(to, radius, ray), rings);
  }
  return samples;
}

}  // namespace

TEST_CASE("box: Euclidean distance in 3D") {
  const BoxShape box({box_lower, box_upper, 3});
  const auto where = random_points(400, {-1.6, 0.1, 1.6}, {2.1, 2.1, 3.5});
  const int n = 100;
  check_exact_distance(box, sample_box(box_lower, box_upper, n), 2.5 / n / std::numbers::sqrt2, where,
                       [](const Point& p) {
                         for (std::size_t a = 0; a < 3; ++a) {
                           if (p[a] < box_lower[a] || p[a] > box_upper[a]) return false;
                         }
                         return true;
                       });
  check_normals(box, where);
  check_lipschitz(box, where);
  CHECK(box.signed_distance({1.5 + 3.0, 1.7 + 4.0, 2.5}) == doctest::Approx(5.0));
}

TEST_CASE("box: in 2D z is not looked at") {
  const BoxShape box({{0, 0, 0}, {2, 1, 0}, 2});
  CHECK(box.signed_distance({1, 0.25, 0}) == doctest::Approx(-0.25));
  CHECK(box.signed_distance({1, 0.25, 100}) == doctest::Approx(-0.25));
  CHECK(box.normal({2.3, 1.4, 0})[0] == doctest::Approx(0.6));
  CHECK(box.normal({2.3, 1.4, 0})[1] == doctest::Approx(0.8));
  CHECK(std::isinf(box.bounds().upper[2]));
}

TEST_CASE("box: edges, corners and the middle have unit normals that point outwards") {
  const BoxShape box({{0, 0, 0}, {1, 1, 0}, 2});
  const double half = std::numbers::sqrt2 / 2;
  const Point corner = box.normal({1, 1, 0});
  CHECK(corner[0] == doctest::Approx(half));
  CHECK(corner[1] == doctest::Approx(half));
  const Point diagonal = box.normal({0.2, 0.8, 0});
  CHECK(diagonal[0] == doctest::Approx(-half));
  CHECK(diagonal[1] == doctest::Approx(half));
  CHECK(point::length(box.normal({0.5, 0.5, 0})) == doctest::Approx(1.0));
  CHECK(box.normal({1, 0.5, 0}) == Point{1, 0, 0});
  CHECK(box.normal({0.5, 0, 0}) == Point{0, -1, 0});
}

TEST_CASE("box: holds its lower faces, not its upper ones, whatever the rounding") {
  const BoxShape box({{0, 0, 0}, {1, 1, 1}, 3});
  CHECK(box.contains({0, 0, 0}));
  CHECK_FALSE(box.contains({1, 0.5, 0.5}));
  CHECK(box.contains({-1e-12, 0.5, 0.5}, 1e-9));
  CHECK_FALSE(box.contains({1 - 1e-12, 0.5, 0.5}, 1e-9));
  CHECK_FALSE(box.contains({-1e-8, 0.5, 0.5}, 1e-9));
}

TEST_CASE("ball") {
  const Ball ball({{1, 2, 3}, 0.7});
  std::vector<Point> surface;
  const int n = 40000;  // Fibonacci sphere
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    surface.push_back({1 + 0.7 * r * std::cos(angle), 2 + 0.7 * r * std::sin(angle), 3 + 0.7 * z});
  }
  const auto where = random_points(300, {0, 1, 2}, {2, 3, 4});
  check_exact_distance(ball, surface, 0.7 * 3.6 / std::sqrt(n), where,
                       [](const Point& p) { return std::hypot(p[0] - 1, p[1] - 2, p[2] - 3) < 0.7; });
  check_normals(ball, where);
  check_lipschitz(ball, where);
  CHECK(point::length(ball.normal({1, 2, 3})) == 1.0);
  CHECK(ball.bounds().lower[0] == doctest::Approx(0.3));
  CHECK(ball.bounds().upper[2] == doctest::Approx(3.7));
}

TEST_CASE("cylinder along a slanted axis") {
  const Point from{0.1, -0.2, 0.3};
  const Point to{1.3, 0.9, 1.4};
  const double radius = 0.6;
  const Cylinder cylinder({from, to, radius});
  const auto where = random_points(500, {-0.5, -0.7, -0.3}, {1.9, 1.4, 2});
  const auto surface = sample_cylinder(from, to, radius, 240, 120);
  check_exact_distance(cylinder, surface, 0.012, where, [&](const Point& p) {
    const Point axis = point::minus(to, from);
    const Point q = point::minus(p, from);
    const double t = point::dot(q, axis) / point::dot(axis, axis);
    return t > 0 && t < 1 && point::length(point::along(q, -t, axis)) < radius;
  });
  check_normals(cylinder, where);
  check_lipschitz(cylinder, where);
  const Box box = cylinder.bounds();
  Point lowest{infinity, infinity, infinity};
  Point highest{-infinity, -infinity, -infinity};
  for (const Point& s : surface) {
    for (std::size_t a = 0; a < 3; ++a) {
      lowest[a] = std::min(lowest[a], s[a]);
      highest[a] = std::max(highest[a], s[a]);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {  // tight: no sample outside, and some sample close to each side
    CHECK(box.lower[a] <= lowest[a] + 1e-12);
    CHECK(box.lower[a] > lowest[a] - 1e-3);
    CHECK(box.upper[a] >= highest[a] - 1e-12);
    CHECK(box.upper[a] < highest[a] + 1e-3);
  }
  CHECK_FALSE(cylinder.valid_in(2));
  CHECK(point::length(cylinder.normal(point::along(from, 0.5, point::minus(to, from)))) ==
        doctest::Approx(1.0));
}

TEST_CASE("half space") {
  const HalfSpace floor({{0, 1, 0}, {0, 2, 0}});
  CHECK(floor.signed_distance({5, 3, 1}) == doctest::Approx(2.0));
  CHECK(floor.signed_distance({5, 0.5, 1}) == doctest::Approx(-0.5));
  CHECK(floor.normal({0, 0, 0}) == Point{0, 1, 0});
  CHECK(floor.bounds().upper[1] == 1.0);
  CHECK(std::isinf(floor.bounds().lower[1]));
  CHECK(std::isinf(floor.bounds().upper[0]));
  const HalfSpace slanted({{1, 1, 1}, {1, 2, -2}});
  CHECK(slanted.signed_distance({4, 1, 1}) == doctest::Approx(1.0));
  const auto where = random_points(100, {-2, -2, -2}, {2, 2, 2});
  check_normals(slanted, where);
  check_lipschitz(slanted, where);
  // Two halves of space share no point and lose none, also on the plane between them.
  const HalfSpace above({{0, 1, 0}, {0, -1, 0}});
  for (const double off : {0.0, 1e-15, -1e-15, 1e-3, -1e-3}) {
    CHECK(floor.contains({0, 1 + off, 0}, 1e-9) != above.contains({0, 1 + off, 0}, 1e-9));
    CHECK(floor.contains({0, 1 + off, 0}) != above.contains({0, 1 + off, 0}));
  }
}

TEST_CASE("the default normal of a shape comes from differences, and survives ridges") {
  class Slab final : public Shape {  // |y| < 1, no normal of its own
   public:
    double signed_distance(const Point& p) const override { return std::abs(p[1]) - 1.0; }
    Box bounds() const override { return {{-infinity, -1, -infinity}, {infinity, 1, infinity}}; }
  };
  const Slab slab;
  CHECK(slab.normal({2, 0.3, 1})[1] == doctest::Approx(1.0));
  CHECK(slab.normal({2, -5.0, 1})[1] == doctest::Approx(-1.0));
  CHECK(std::abs(slab.normal({0, 0, 0})[1]) == doctest::Approx(1.0));  // on the ridge
  CHECK(slab.contains({0, 1, 0}));
  CHECK_FALSE(slab.contains({0, 1.001, 0}));
}

TEST_CASE("primitives refuse what they cannot be") {
  const double nan = std::nan("");
  using Bad = std::invalid_argument;
  CHECK(refusal<Bad>([] {
          return BoxShape({{0, 2, 0}, {1, 1, 0}, 2}).bounds();
        }) ==
        "the lower corner of a box must lie below its upper corner, but along y lower is 2 and upper is 1");
  CHECK(refusal<Bad>([] {
          return BoxShape({{0, 0, 0}, {1, 1, 0}, 3}).bounds();
        }) ==
        "the lower corner of a box must lie below its upper corner, but along z lower is 0 and upper is 0");
  CHECK(refusal<Bad>([&] {
          return BoxShape({{nan, 0, 0}, {1, 1, 1}, 3}).bounds();
        }).find("along x") != std::string::npos);
  CHECK(refusal<Bad>([] {
          return BoxShape({{0, 0, 0}, {1, 1, 1}, 1}).bounds();
        }) == "a box has 2 or 3 dimensions, not 1");
  CHECK(refusal<Bad>([] {
          return Ball({{0, 0, 0}, 0}).bounds();
        }) == "the radius of a ball must be positive, but is 0");
  CHECK(refusal<Bad>([&] {
          return Ball({{0, 0, 0}, nan}).bounds();
        }) == "the radius of a ball must be positive, but is nan");
  CHECK(refusal<Bad>([&] {
          return Ball({{0, nan, 0}, 1}).bounds();
        }) == "the centre of a ball must be finite, but is (0, nan, 0)");
  CHECK(refusal<Bad>([] {
          return Cylinder({{0, 0, 0}, {0, 0, 1}, -1}).bounds();
        }) == "the radius of a cylinder must be positive, but is -1");
  CHECK(refusal<Bad>([] {
          return Cylinder({{0, 0, 1}, {0, 0, 1}, 1}).bounds();
        }) == "the ends of a cylinder must differ; 'from' and 'to' are the same point");
  CHECK(refusal<Bad>([] {
          return HalfSpace({{0, 0, 0}, {0, 0, 0}}).bounds();
        }) == "the normal of a half space must not be zero; it points out of the shape");
}
