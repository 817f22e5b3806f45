// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The cell sort by itself: a permutation, stable, with cells where they belong.
#include "kernel/neighbours/neighbour_grid.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "reference.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::testing;

namespace {

void check_sort(const Cloud& cloud, double cutoff) {
  NeighbourGrid grid;
  grid.build(cloud.positions(), cutoff);
  const std::size_t n = cloud.size();
  const auto d = static_cast<std::size_t>(cloud.dimensions);
  std::vector<int> seen(n, 0);
  int errors = 0;
  for (std::size_t k = 0; k < n; ++k) {
    ++seen[grid.order()[k]];
    for (std::size_t a = 0; a < d; ++a)
      errors += grid.sorted(static_cast<int>(a))[k] != cloud.x[grid.order()[k] * d + a];
  }
  CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  CHECK(grid.cell_start()[0] == 0);
  CHECK(grid.cell_start()[grid.n_cells()] == n);
  for (std::uint64_t c = 0; c < grid.n_cells(); ++c) {
    for (std::uint32_t k = grid.cell_start()[c]; k < grid.cell_start()[c + 1]; ++k) {
      // the cell number, taken apart again, is the cell of each coordinate
      std::uint64_t rest = c;
      for (int rank = 0; rank < cloud.dimensions; ++rank) {
        const auto cells = static_cast<std::uint64_t>(grid.map(rank).cells());
        errors +=
            grid.map(rank).cell(grid.sorted(grid.axis(rank))[k]) != static_cast<std::int64_t>(rest % cells);
        rest /= cells;
      }
      if (k > grid.cell_start()[c]) errors += grid.order()[k] < grid.order()[k - 1];  // stable
    }
  }
  CHECK(errors == 0);
}

}  // namespace

TEST_CASE("the cell sort is a stable permutation") {
  for (int d : {2, 3}) {
    check_sort(random_cloud(d, 3000, -5.0, 3.0, 1), 0.4);
    check_sort(random_cloud(d, 100, 0.0, 1e7, 2), 0.4);  // mostly empty space
    check_sort(random_cloud(d, 20000, 0.0, 1.0, 3), 0.05);
    check_sort(Cloud{d, {}}, 1.0);
  }
}

TEST_CASE("the longest extent is the slowest axis") {
  Cloud cloud = random_cloud(3, 500, 0.0, 1.0, 4);
  for (std::size_t i = 0; i < cloud.x.size(); i += 3) cloud.x[i] *= 9.0;
  for (std::size_t i = 2; i < cloud.x.size(); i += 3) cloud.x[i] *= 3.0;
  NeighbourGrid grid;
  grid.build(cloud.positions(), 0.3);
  CHECK(grid.axis(0) == 1);
  CHECK(grid.axis(1) == 2);
  CHECK(grid.axis(2) == 0);
}

TEST_CASE("a compressed axis keeps distances up to the cut-off and its order") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> x;
  double place = -1e4;
  for (int i = 0; i < 300; ++i) {
    place += uniform(random) < 0.7 ? 0.5 * uniform(random) : 20.0 * uniform(random);
    x.push_back(place);
  }
  AxisMap map;
  map.set_compressed(x.data(), x.size(), 1, 1.0, 4);
  CHECK(map.cells() < 4 * 3 * 300);
  CHECK(map.cell_width() == 0.25);
  double previous = -1e300;
  int errors = 0;
  for (double p = x.front() - 3.0; p < x.back() + 3.0; p += 0.01) {
    const double u = map.locate(p);
    errors += u < previous;
    previous = u;
    for (double other : x) {
      const double distance = std::abs(p - other), mapped = std::abs(u - map.locate(other)) / 4.0;
      if (distance < 1.0) errors += std::abs(mapped - distance) > 1e-9;
    }
  }
  for (double other : x) errors += map.cell(other) < 0 || map.cell(other) >= map.cells();
  CHECK(errors == 0);
}

TEST_CASE("an axis locates many coordinates as it does each") {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> held = {0.0, 0.4, 1.7, 300.0, 301.0, 4e6};
  AxisMap uniform, compressed;
  uniform.set_uniform(-2.0, 30.0, 0.5, 8);
  compressed.set_compressed(held.data(), held.size(), 1, 0.5, 8);
  REQUIRE_FALSE(compressed.is_uniform());
  std::vector<double> x;
  for (double c : {-inf, -1e300, -1e6, -2.0, -0.1, 0.0, 0.26, 1.7, 150.0, 300.0, 301.2, 4e6, 1e300, inf, nan})
    x.insert(x.end(), {c, -7.0, 9.0});  // a stride of three
  for (const AxisMap* map : {&uniform, &compressed}) {
    std::vector<double> u(x.size() / 3);
    map->locate(x.data(), u.size(), 3, u.data());
    for (std::size_t i = 0; i < u.size(); ++i) {
      CAPTURE(x[3 * i]);
      CHECK(u[i] == map->locate(x[3 * i]));
      CHECK(std::abs(u[i]) <= AxisMap::far);
    }
    const double first = map->locate(held[0]);
    CHECK(map->locate(held[1]) - first == doctest::Approx(0.4 / 0.5 * 8));
    CHECK(static_cast<std::int64_t>(std::floor(first)) == map->cell(held[0]));
  }
  CHECK(uniform.locate(0.0) == 32.0);
  CHECK(uniform.locate(nan) == -AxisMap::far);
}
