// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "wall_motion.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "particles.hpp"

using namespace shoal;
using namespace shoal::fluid;
using namespace shoal::fluid::test;

TEST_CASE("a table is met at its rows, with continuous slopes between them") {
  std::ofstream("motion.csv") << "# a comment\ntime,x,y,angle\n0,0,0,0\n1,1,0,0.5\n2, 4,0,1\n3,9,0,1.5\n";
  const MotionTable table(std::string("motion.csv"));
  REQUIRE(table.n_columns() == 3);
  CHECK(table.value(0, 1.0) == doctest::Approx(1.0));
  CHECK(table.value(0, 1.5) == doctest::Approx(2.25));  // t^2 with exact central slopes
  CHECK(table.value(2, 2.25) == doctest::Approx(1.125));
  CHECK(table.value(0, -1.0) == 0.0);
  CHECK(table.value(0, 7.0) == 9.0);
  const double before = (table.value(0, 2.0) - table.value(0, 2.0 - 1e-6)) / 1e-6;
  const double after = (table.value(0, 2.0 + 1e-6) - table.value(0, 2.0)) / 1e-6;
  CHECK(before == doctest::Approx(4.0).epsilon(1e-4));
  CHECK(after == doctest::Approx(4.0).epsilon(1e-4));
}

TEST_CASE("tables that are none are refused") {
  std::ofstream("one.csv") << "0,1\n";
  CHECK_THROWS_WITH_AS(MotionTable(std::string("one.csv")), "'one.csv' needs two rows of numbers at least",
                       CaseError);
  std::ofstream("back.csv") << "0,1\n1,2\n1,3\n";
  CHECK_THROWS_WITH_AS(MotionTable(std::string("back.csv")), "'back.csv': times must rise", CaseError);
  std::ofstream("ragged.csv") << "0,1\n1,2,3\n";
  CHECK_THROWS_WITH_AS(MotionTable(std::string("ragged.csv")),
                       "'ragged.csv': a row has 3 numbers, the first has 2", CaseError);
}

TEST_CASE("a wall follows its path, its velocities and normals with it") {
  for (const int dimensions : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimensions);
    const auto motion = std::make_shared<Motion>();
    motion->dimensions = dimensions;
    motion->centre = {1.0, 0.0, 0.0};
    // x moves with 2 m/s, the angle grows with 0.5 rad/s
    std::vector<std::vector<double>> columns(d + 1, std::vector<double>{-20.0, 20.0});
    for (std::size_t a = 1; a < d; ++a) columns[a] = {0.0, 0.0};
    columns[d] = {-5.0, 5.0};
    motion->table = MotionTable({-10.0, 10.0}, columns);
    std::vector<double> point(d, 0.0), normal(d, 0.0);
    point[0] = 3.0;
    normal[1] = 1.0;
    Body wall(dimensions, point);
    wall["reference_position"] = point;
    wall["reference_normal"] = normal;
    MoveWall op;
    op.motion = motion;
    op.share = 0.5;
    testing::run(op, wall, {}, {.smoothing_length = 0.1, .spacing = 0.1, .dt = 0.002, .time = 0.4});
    const double angle = 0.5 * 0.401;
    CHECK(wall["position"][0] == doctest::Approx(1.0 + 2.0 * 0.401 + 2.0 * std::cos(angle)));
    CHECK(wall["position"][1] == doctest::Approx(2.0 * std::sin(angle)));
    CHECK(wall["velocity"][0] == doctest::Approx(2.0 - 2.0 * 0.5 * std::sin(angle)).epsilon(1e-5));
    CHECK(wall["velocity"][1] == doctest::Approx(2.0 * 0.5 * std::cos(angle)).epsilon(1e-5));
    CHECK(wall["normal"][0] == doctest::Approx(-std::sin(angle)));
    CHECK(wall["normal"][1] == doctest::Approx(std::cos(angle)));
  }
}

TEST_CASE("rotation about an axis in space") {
  const double third = 2.0 * std::numbers::pi / 3.0, s = 1.0 / std::sqrt(3.0);
  const Vec<3> x = rotated(Vec<3>{1.0, 2.0, 3.0}, {s, s, s}, third);  // x -> y -> z -> x
  CHECK(x[0] == doctest::Approx(3.0));
  CHECK(x[1] == doctest::Approx(1.0));
  CHECK(x[2] == doctest::Approx(2.0));
}
