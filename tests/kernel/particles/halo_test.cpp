// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Images against brute force: every repetition and reflection of the box, written out.
#include "kernel/particles/halo.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernel/particles/body.hpp"
#include "kernel/particles/errors.hpp"

using namespace shoal::kernel;

namespace {

using Point = std::array<double, 3>;

struct Image {
  std::uint32_t source;
  Point position;
  Point sign;
};

// All images, whose distance to the box is at most `reach` along every axis.
std::vector<Image> explicit_images(const Domain& domain, double reach, const std::vector<Point>& points) {
  struct Map {
    double sign, shift;
  };
  std::vector<Map> maps[3];
  for (int a = 0; a < 3; ++a) {
    maps[a].push_back({1.0, 0.0});
    if (a >= domain.dimensions) continue;
    if (domain.periodic(a))
      for (int k = 1; k <= 9; ++k) {
        maps[a].push_back({1.0, k * domain.length(a)});
        maps[a].push_back({1.0, -k * domain.length(a)});
      }
    if (domain.boundary[a].lower == BoundaryKind::mirror) maps[a].push_back({-1.0, 2.0 * domain.lower[a]});
    if (domain.boundary[a].upper == BoundaryKind::mirror) maps[a].push_back({-1.0, 2.0 * domain.upper[a]});
  }
  std::vector<Image> images;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (std::size_t x = 0; x < maps[0].size(); ++x)
      for (std::size_t y = 0; y < maps[1].size(); ++y)
        for (std::size_t z = 0; z < maps[2].size(); ++z) {
          if (x + y + z == 0) continue;
          const Map map[3] = {maps[0][x], maps[1][y], maps[2][z]};
          Image image{i, {}, {}};
          bool inside = true;
          for (std::size_t a = 0; a < 3; ++a) {
            image.sign[a] = map[a].sign;
            image.position[a] = map[a].sign * points[i][a] + map[a].shift;
            const bool mapped = map[a].shift != 0.0 || map[a].sign < 0.0;
            inside = inside && (!mapped || (image.position[a] >= domain.lower[a] - reach &&
                                            image.position[a] <= domain.upper[a] + reach));
          }
          if (inside) images.push_back(image);
        }
  return images;
}

Domain box(int dimensions, std::array<double, 3> upper, std::array<BoundaryKind, 3> kinds) {
  Domain domain;
  domain.dimensions = dimensions;
  for (int a = 0; a < dimensions; ++a) {
    const auto k = static_cast<std::size_t>(a);
    domain.lower[a] = -0.5;
    domain.upper[a] = upper[k];
    domain.boundary[a] = {kinds[k], kinds[k]};
  }
  return domain;
}

void compare(const Domain& domain, double reach, std::size_t n) {
  std::mt19937 random(7);
  std::vector<Point> points(n, Point{0, 0, 0});
  std::vector<double> positions;
  const auto d = static_cast<std::size_t>(domain.dimensions);
  for (Point& point : points)
    for (std::size_t a = 0; a < d; ++a) {
      const int axis = static_cast<int>(a);
      point[a] = std::uniform_real_distribution<double>(domain.lower[axis], domain.upper[axis])(random);
      positions.push_back(point[a]);
    }
  Body body("b", 0, domain.dimensions);
  body.resize(n);
  std::copy(positions.begin(), positions.end(), body.position().reals());
  Field& velocity = body.declare({"velocity", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, "m/s", ""}, "t");
  Field& scalar = body.declare({"s", SHOAL_SCALAR, SHOAL_DOUBLE, "1", ""}, "t");
  Field& matrix = body.declare({"m", SHOAL_RANK_MATRIX, SHOAL_DOUBLE, "1", ""}, "t");
  Field& symmetric = body.declare({"y", SHOAL_SYMMETRIC, SHOAL_DOUBLE, "1", ""}, "t");
  Field& integer = body.declare({"k", SHOAL_RANK_VECTOR, SHOAL_INT64, "1", ""}, "t");
  for (Field* field : {&velocity, &scalar, &matrix, &symmetric})
    for (std::uint64_t k = 0; k < n * field->components(); ++k)
      field->reals()[k] = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  for (std::uint64_t k = 0; k < n * d; ++k) integer.integers()[k] = static_cast<std::int64_t>(random());

  body.build_halo(domain, reach);
  for (const auto& field : body.fields()) body.renew_halo(*field);
  std::vector<Image> expected = explicit_images(domain, reach, points);
  REQUIRE(body.n_halo() == expected.size());

  // Both in one order: by source, then by position.
  std::vector<std::uint64_t> found(expected.size());
  for (std::uint64_t k = 0; k < found.size(); ++k) found[k] = k;
  const auto place = [&](std::uint64_t image, std::size_t a) {
    return std::round(body.position().reals()[(n + image) * d + a] * 1e9);
  };
  std::sort(found.begin(), found.end(), [&](std::uint64_t a, std::uint64_t b) {
    if (body.halo().source(a) != body.halo().source(b)) return body.halo().source(a) < body.halo().source(b);
    for (std::size_t axis = 0; axis < d; ++axis)
      if (place(a, axis) != place(b, axis)) return place(a, axis) < place(b, axis);
    return false;
  });
  std::sort(expected.begin(), expected.end(), [&](const Image& a, const Image& b) {
    if (a.source != b.source) return a.source < b.source;
    for (std::size_t axis = 0; axis < d; ++axis) {
      const double x = std::round(a.position[axis] * 1e9), y = std::round(b.position[axis] * 1e9);
      if (x != y) return x < y;
    }
    return false;
  });
  bool same = true;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Image& image = expected[k];
    const std::uint64_t i = n + found[k], s = image.source;
    same = same && body.halo().source(found[k]) == s && scalar.reals()[i] == scalar.reals()[s];
    std::size_t pair = 0;
    for (std::size_t a = 0; a < d; ++a) {
      same = same && std::abs(body.position().reals()[i * d + a] - image.position[a]) < 1e-12;
      same = same && velocity.reals()[i * d + a] == image.sign[a] * velocity.reals()[s * d + a];
      same = same && integer.integers()[i * d + a] == integer.integers()[s * d + a];
      for (std::size_t b = 0; b < d; ++b)
        same = same && matrix.reals()[(i * d + a) * d + b] ==
                           image.sign[a] * image.sign[b] * matrix.reals()[(s * d + a) * d + b];
      for (std::size_t b = a; b < d; ++b, ++pair) {
        const std::size_t c = symmetric.components();
        same = same && symmetric.reals()[i * c + pair] ==
                           image.sign[a] * image.sign[b] * symmetric.reals()[s * c + pair];
      }
    }
  }
  CHECK(same);
}

constexpr auto open = BoundaryKind::open;
constexpr auto periodic = BoundaryKind::periodic;
constexpr auto mirror = BoundaryKind::mirror;

}  // namespace

TEST_CASE("images in two dimensions") {
  compare(box(2, {1.0, 0.7, 0.0}, {periodic, open, open}), 0.2, 300);
  compare(box(2, {1.0, 0.7, 0.0}, {periodic, periodic, open}), 0.2, 300);
  compare(box(2, {1.0, 0.7, 0.0}, {mirror, periodic, open}), 0.2, 300);
  compare(box(2, {1.0, 0.7, 0.0}, {mirror, mirror, open}), 0.3, 300);
  compare(box(2, {1.0, 0.7, 0.0}, {open, open, open}), 0.3, 300);
}

TEST_CASE("images in three dimensions, and large bodies") {
  compare(box(3, {1.0, 0.7, 0.5}, {periodic, periodic, periodic}), 0.2, 300);
  compare(box(3, {1.0, 0.7, 0.5}, {periodic, periodic, open}), 0.2, 300);
  compare(box(3, {1.0, 0.7, 0.5}, {mirror, periodic, mirror}), 0.2, 300);
  compare(box(3, {1.0, 0.7, 0.5}, {periodic, mirror, open}), 0.1, 12000);
}

TEST_CASE("a periodic box may be narrower than the cut-off") {
  compare(box(2, {1.0, -0.4, 0.0}, {periodic, periodic, open}), 0.25, 60);
  compare(box(3, {1.0, -0.45, -0.42}, {periodic, periodic, periodic}), 0.12, 60);
}

TEST_CASE("one mirror plane alone reflects what is near it") {
  Domain domain;
  domain.dimensions = 2;
  domain.lower[1] = 0.0;
  domain.boundary[1].lower = mirror;
  Body body("b", 0, 2);
  body.resize(4);
  const double positions[] = {3.0, 0.05, 4.0, 0.25, 5.0, 0.0, 6.0, -0.01};
  std::copy(std::begin(positions), std::end(positions), body.position().reals());
  body.build_halo(domain, 0.2);
  body.renew_halo(body.position());
  // The second is too far away; the third stands in the plane and is its own image.
  REQUIRE(body.n_halo() == 2);
  CHECK(body.halo().source(0) == 0);
  CHECK(body.position().reals()[8] == 3.0);
  CHECK(body.position().reals()[9] == doctest::Approx(-0.05));
  CHECK(body.halo().source(1) == 3);
  CHECK(body.position().reals()[11] == doctest::Approx(0.01));
}

TEST_CASE("images follow their sources between renewals") {
  const Domain domain = box(2, {1.0, 0.7, 0.0}, {periodic, open, open});
  Body body("b", 0, 2);
  body.resize(1);
  body.position().reals()[0] = -0.45;
  body.build_halo(domain, 0.1);
  body.position().reals()[0] = -0.4;
  body.position().reals()[1] = 0.2;
  body.renew_halo(body.position());
  REQUIRE(body.n_halo() == 1);
  CHECK(body.position().reals()[2] == doctest::Approx(1.1));
  CHECK(body.position().reals()[3] == 0.2);
}

TEST_CASE("images of arrays are copies, behind mirrors too") {
  Domain domain;
  domain.dimensions = 2;
  domain.lower[1] = 0.0;
  domain.boundary[1].lower = mirror;
  Body body("b", 0, 2);
  body.declare(specify("gates", SHOAL_ARRAY, SHOAL_DOUBLE, "1", nullptr, "cell", 5), "cell");
  body.resize(2);
  const double positions[] = {3.0, 0.5, 4.0, 0.05};
  std::copy(std::begin(positions), std::end(positions), body.position().reals());
  Field& gates = *body.find("gates");
  for (std::size_t k = 0; k < 10; ++k) gates.reals()[k] = static_cast<double>(k) - 3.0;
  body.build_halo(domain, 0.2);
  body.renew_halo(gates);
  REQUIRE(body.n_halo() == 1);
  for (std::size_t k = 0; k < 5; ++k) CHECK(gates.reals()[10 + k] == gates.reals()[5 + k]);
}

TEST_CASE("a mirror in a domain narrower than the cut-off is refused") {
  const Domain domain = box(2, {-0.4, 0.7, 0.0}, {mirror, open, open});
  Body body("b", 0, 2);
  body.resize(1);
  CHECK_THROWS_WITH_AS(
      body.build_halo(domain, 0.2),
      "the domain is narrower along x (0.100000 m) than the cut-off (0.200000 m), so a mirror plane "
      "there would need images of images; make it wider",
      ModelError);
}

TEST_CASE("wrapping brings particles back and leaves those inside as they are") {
  const Domain domain = box(2, {1.0, 0.7, 0.0}, {periodic, open, open});
  std::vector<double> x = {-0.5, 3.0, 1.0, 3.0, 1.25, -9.0, -0.6, 0.0, 0.3333, 0.1, -0.5 - 1e-17, 0.0};
  CHECK(wrap(domain, x.data(), 6));
  CHECK(x[0] == -0.5);
  CHECK(x[2] == -0.5);
  CHECK(x[4] == doctest::Approx(-0.25));
  CHECK(x[5] == -9.0);
  CHECK(x[6] == doctest::Approx(0.9));
  CHECK(x[8] == 0.3333);
  CHECK(x[10] < 1.0);
  CHECK_FALSE(wrap(domain, x.data(), 6));
  double nan[] = {std::nan(""), 0.0};
  wrap(domain, nan, 1);
  CHECK(std::isnan(nan[0]));
}
