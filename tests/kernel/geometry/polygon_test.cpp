// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Polygons: distance, inside, orientation, and the refusal of what is not simple.
#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "support.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::test;

namespace {

// Concave, with a horizontal edge, a notch, a collinear vertex and a sharp tip.
const std::vector<Point> shape_of_letters{{0, 0, 0},     {2, 0, 0},   {4, 0, 0},     {4, 1, 0}, {1.5, 1, 0},
                                          {1.2, 1.4, 0}, {1.5, 2, 0}, {3.5, 2.1, 0}, {1, 3, 0}, {0, 3, 0}};

/// Inside by the sum of angles under which the edges are seen: slow, and unlike the code under test.
bool inside_by_angles(const std::vector<Point>& v, const Point& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Point a = point::minus(v[i], p);
    const Point b = point::minus(v[(i + 1) % v.size()], p);
    sum += std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  }
  return std::abs(sum) > std::numbers::pi;
}

}  // namespace

TEST_CASE("polygon: exact distance, sign, normals; either orientation") {
  auto vertices = shape_of_letters;
  auto where = random_points(600, {-1, -1, 0}, {5, 4, 0});
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(vertices.begin(), vertices.end());
    const Polygon polygon({vertices});
    check_exact_distance(polygon, sample_polygon(vertices, 2000), 0.0011, where,
                         [&](const Point& p) { return inside_by_angles(vertices, p); });
    check_normals(polygon, where);
    check_lipschitz(polygon, where);
    CHECK(polygon.area() == doctest::Approx(7.625));  // shoelace by hand
  }
}

TEST_CASE("polygon: area does not depend on orientation or on the closing vertex") {
  const Polygon triangle({{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}});
  const Polygon closed({{{0, 0, 0}, {0, 3, 0}, {4, 0, 0}, {0, 0, 0}}});
  CHECK(triangle.area() == doctest::Approx(6.0));
  CHECK(closed.area() == doctest::Approx(6.0));
  CHECK(triangle.signed_distance({1, 1, 0}) == doctest::Approx(closed.signed_distance({1, 1, 0})));
}

TEST_CASE("polygon: the ray through vertices and along edges counts right") {
  // Points at the height of vertices are where crossing counts go wrong.
  const Polygon diamond({{{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}});
  CHECK(diamond.signed_distance({0, 0, 0}) == doctest::Approx(-std::numbers::sqrt2 / 2));
  CHECK(diamond.signed_distance({-2, 0, 0}) == doctest::Approx(1.0));
  CHECK(diamond.signed_distance({2, 0, 0}) == doctest::Approx(1.0));
  CHECK(diamond.signed_distance({-1, 1, 0}) == doctest::Approx(std::numbers::sqrt2 / 2));
  CHECK(diamond.signed_distance({-3, 1, 0}) > 0);
  CHECK(diamond.signed_distance({-3, -1, 0}) > 0);
  const Polygon steps(
      {{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}}});
  CHECK(steps.signed_distance({-1, 1, 0}) == doctest::Approx(1.0));
  CHECK(steps.signed_distance({-1, 2, 0}) == doctest::Approx(std::sqrt(2.0)));
  CHECK(steps.signed_distance({1.5, 1, 0}) == doctest::Approx(-0.5));
  CHECK(steps.signed_distance({0.5, 0.5, 0}) == doctest::Approx(-0.5));
}

TEST_CASE("polygon: normals on edges and vertices") {
  const Polygon square({{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}});
  CHECK(square.normal({1, 0.5, 0}) == Point{1, 0, 0});
  CHECK(square.normal({0.5, 0, 0})[1] == doctest::Approx(-1.0));
  const double half = std::numbers::sqrt2 / 2;
  CHECK(square.normal({1, 1, 0})[0] == doctest::Approx(half));
  CHECK(square.normal({1, 1, 0})[1] == doctest::Approx(half));
  CHECK(square.normal({1.3, 1.4, 0})[0] == doctest::Approx(0.6));
  // A re-entrant corner: from inside, the vertex is the nearest point and the normal points at it.
  const Polygon ell({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}});
  CHECK(ell.signed_distance({0.7, 0.6, 0}) == doctest::Approx(-0.5));
  CHECK(ell.normal({0.7, 0.6, 0})[0] == doctest::Approx(0.6));
  CHECK(ell.normal({0.7, 0.6, 0})[1] == doctest::Approx(0.8));
}

TEST_CASE("polygon: neighbours share no lattice point and lose none") {
  // A unit square cut along its diagonal, on which lattice points lie.
  const Polygon below({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}});
  const Polygon above({{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const Point p{0.1 * (i + 0.5), 0.1 * (j + 0.5), 0};
      CHECK(below.contains(p, 1e-7) != above.contains(p, 1e-7));
    }
  }
}

TEST_CASE("polygon: refuses fewer than three vertices, crossings and touching") {
  using Bad = std::invalid_argument;
  const auto text = [](std::vector<Point> v) { return refusal<Bad>([&] { return Polygon({v}).area(); }); };
  CHECK(text({{0, 0, 0}, {1, 0, 0}}) == "a polygon needs at least 3 different vertices, but has 2");
  CHECK(text({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}) ==
        "a polygon needs at least 3 different vertices, but has 2");
  CHECK(text({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}) ==
        "a polygon must not cross or touch itself, but its edges from (0, 0) to (1, 1) and from (1, 0) to "
        "(0, 1) meet");
  CHECK(text({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0, 0}, {0, 2, 0}}).find("cross or touch") !=
        std::string::npos);
  CHECK(text({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}) ==
        "a polygon has the vertex (1, 0) twice in a row");
  CHECK(text({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}}).find("runs back on itself") != std::string::npos);
  CHECK(text({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).find("polygon") != std::string::npos);
  CHECK(text({{0, 0, 0}, {1, 0, 0}, {std::nan(""), 1, 0}}) == "the vertices of a polygon must be finite");
  CHECK(text({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}}).empty());  // a vertex along an edge is fine
}
