// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Neighbour lists against all pairs, on every scan path this program was compiled with.
#include "kernel/neighbours/neighbour_list.hpp"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "reference.hpp"

using namespace shoal::kernel;
using namespace shoal::kernel::testing;

namespace {

constexpr ScanPath all_paths[] = {ScanPath::fastest, ScanPath::plain, ScanPath::avx2, ScanPath::avx512};

// Builds with every path; all must equal the brute-force rows, and each other in order.
void check_list(const Cloud& targets, std::size_t n_targets, const Cloud& sources, double cutoff,
                bool same_body, double grid_cutoff = 0.0) {
  const auto expected = all_pairs(targets, n_targets, sources, cutoff, same_body);
  NeighbourGrid grid;
  grid.build(sources.positions(), grid_cutoff > 0.0 ? grid_cutoff : cutoff);
  NeighbourList first;
  first.build(grid, {targets.x.data(), n_targets, targets.dimensions}, cutoff, same_body);
  const auto rows = rows_of(first);
  CHECK(sorted_rows(rows) == expected);
  CHECK(layout_errors(first) == 0);
  for (ScanPath path : all_paths) {
    if (!is_available(path)) continue;
    NeighbourList list;
    list.build(grid, {targets.x.data(), n_targets, targets.dimensions}, cutoff, same_body, path);
    CHECK(rows_of(list) == rows);
    CHECK(layout_errors(list) == 0);
  }
}
void check_self(const Cloud& cloud, double cutoff) { check_list(cloud, cloud.size(), cloud, cutoff, true); }

}  // namespace

TEST_CASE("random clouds in two and three dimensions") {
  for (int d : {2, 3})
    for (double cutoff : {0.03, 0.11, 0.4, 5.0}) {
      CAPTURE(d);
      CAPTURE(cutoff);
      check_self(random_cloud(d, 700, -0.7, 0.4, 5), cutoff);
    }
}

TEST_CASE("a jittered lattice with the cut-off of 2.6 spacings") {
  check_self(jittered_lattice(2, 40, 0.025, 0.2, 1), 2.6 * 0.025);
  check_self(jittered_lattice(3, 13, 0.025, 0.2, 2), 2.6 * 0.025);
}

TEST_CASE("thin and long boxes, whichever axis is the long one") {
  for (int long_axis = 0; long_axis < 3; ++long_axis) {
    Cloud cloud = random_cloud(3, 800, 0.0, 1.0, 9);
    for (std::size_t i = 0; i < cloud.x.size(); ++i)
      cloud.x[i] *= static_cast<int>(i % 3) == long_axis ? 30.0 : (static_cast<int>(i % 3) == 1 ? 0.01 : 1.0);
    check_self(cloud, 0.35);
  }
}

TEST_CASE("clusters of very different density") {
  Cloud cloud = random_cloud(3, 300, 0.0, 1.0, 3);
  const Cloud dense = random_cloud(3, 400, 0.50, 0.52, 4);
  cloud.x.insert(cloud.x.end(), dense.x.begin(), dense.x.end());
  check_self(cloud, 0.05);
}

TEST_CASE("coincident particles are neighbours of each other, not of themselves") {
  Cloud cloud = random_cloud(3, 50, 0.0, 1.0, 6);
  for (int copy = 0; copy < 20; ++copy) cloud.add({0.5, 0.5, 0.5});
  check_self(cloud, 0.2);
  Cloud all_equal{2, {}};
  for (int copy = 0; copy < 100; ++copy) all_equal.add({-3.0, 7.0});
  check_self(all_equal, 1.0);
}

TEST_CASE("one particle and none") {
  check_self(Cloud{3, {0.1, 0.2, 0.3}}, 1.0);
  check_self(Cloud{2, {}}, 1.0);
  const Cloud some = random_cloud(2, 40, 0.0, 1.0, 8), empty{2, {}};
  check_list(some, some.size(), empty, 0.3, false);
  check_list(empty, 0, some, 0.3, false);
}

TEST_CASE("two bodies of different resolution, overlapping, apart and one inside the other") {
  for (int d : {2, 3}) {
    const Cloud fine = random_cloud(d, 900, 0.0, 1.0, 10), coarse = random_cloud(d, 120, -0.5, 1.5, 11);
    const Cloud far = random_cloud(d, 100, 40.0, 41.0, 12);
    check_list(fine, fine.size(), coarse, 0.2, false);
    check_list(coarse, coarse.size(), fine, 0.2, false);
    check_list(coarse, coarse.size(), far, 0.2, false);
    check_list(far, far.size(), coarse, 0.2, false);
  }
}

TEST_CASE("only the owned particles have rows, halo particles are neighbours") {
  const Cloud cloud = random_cloud(3, 600, 0.0, 1.0, 13);
  check_list(cloud, 250, cloud, 0.25, true);
}

TEST_CASE("a list with a shorter cut-off than its grid") {
  for (int d : {2, 3}) {
    const Cloud cloud = random_cloud(d, 600, 0.0, 1.0, 14);
    check_list(cloud, cloud.size(), cloud, 0.07, true, 0.3);
  }
}

TEST_CASE("a particle exactly at the cut-off is not a neighbour") {
  // Multiples of 1/4 and their squares are exact, so the comparison is decided without rounding.
  const Cloud lattice = jittered_lattice(3, 9, 0.25, 0.0, 0);
  check_self(lattice, 0.5);
  NeighbourGrid grid;
  grid.build(lattice.positions(), 0.5);
  NeighbourList list;
  list.build(grid, lattice.positions(), 0.5, true);
  const std::size_t middle = 4 + 9 * (4 + 9 * 4);
  CHECK(list.counts()[middle] == 26);  // within 2 spacings: 6 + 12 + 8; the 6 at exactly 2 spacings are not
  grid.build(lattice.positions(), std::nextafter(0.5, 1.0));
  list.build(grid, lattice.positions(), std::nextafter(0.5, 1.0), true);
  CHECK(list.counts()[middle] == 32);
  check_self(jittered_lattice(2, 20, 0.25, 0.0, 0), 0.75);
}

TEST_CASE("particles on the faces of cells, with the cut-off a multiple of the spacing") {
  // 0.1 has no exact binary form, so neighbouring cells are decided by rounding; only rows must not miss anyone.
  for (double shift : {0.0, 1e6, -12345.678}) {
    Cloud cloud = jittered_lattice(3, 8, 0.1, 0.0, 0);
    for (double& c : cloud.x) c += shift;
    check_self(cloud, 0.25);
  }
}

TEST_CASE("far outliers cost neither memory nor neighbours nor time") {
  for (int d : {2, 3}) {
    Cloud cloud = random_cloud(d, 2000, 0.0, 1.0, 15);
    std::vector<double> far(static_cast<std::size_t>(d), 1e9);
    cloud.add(far);
    far[0] = -3e7;
    cloud.add(far);
    check_self(cloud, 0.1);
    NeighbourGrid grid;
    grid.build(cloud.positions(), 0.1);
    CHECK(grid.n_cells() <= 4096 + 8 * cloud.size());
    CHECK(grid.n_invalid() == 0);
  }
}

TEST_CASE("two dense clouds far apart are searched at the price of two near ones") {
  // Cells enlarged to span both would hold each cloud whole: all pairs, 100 times more candidates than this bound.
  Cloud cloud = random_cloud(3, 20000, 0.0, 1.0, 16);
  for (std::size_t i = cloud.x.size() / 2; i < cloud.x.size(); ++i) cloud.x[i] += 1e6;
  NeighbourGrid grid;
  grid.build(cloud.positions(), 0.05);
  CHECK(grid.n_cells() <= 4096 + 8 * cloud.size());
  std::uint32_t fullest = 0;
  for (std::uint64_t c = 0; c < grid.n_cells(); ++c)
    fullest = std::max(fullest, grid.cell_start()[c + 1] - grid.cell_start()[c]);
  CHECK(fullest < 40);
  Cloud small{3, {}};  // brute force on a part of it
  small.x.assign(cloud.x.begin() + 29000, cloud.x.begin() + 31000 + 1000);
  check_self(small, 0.05);
}

TEST_CASE("particles strung out along a diagonal with wide gaps") {
  Cloud cloud{3, {}};
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double s = 0.0;
  for (int i = 0; i < 1500; ++i) {
    s += uniform(random) < 0.5 ? 0.3 * uniform(random) : 100.0 * uniform(random);
    cloud.add({s, s + 0.1 * uniform(random), -s});
  }
  check_self(cloud, 0.8);
}

TEST_CASE("gaps between clusters, with targets of another body inside and beside the gaps") {
  for (int d : {2, 3}) {
    Cloud sources{d, {}}, targets{d, {}};
    std::mt19937_64 random(18);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 400; ++i) {
      std::vector<double> p, q;
      for (int a = 0; a < d; ++a) {
        p.push_back(2000.0 * (i % 5) + uniform(random));
        q.push_back(2000.0 * (i % 5) + 5.0 * uniform(random) - 2.0);
      }
      sources.add(p);
      targets.add(q);
    }
    targets.add(std::vector<double>(static_cast<std::size_t>(d), 1000.0));
    targets.add(std::vector<double>(static_cast<std::size_t>(d), -1e15));
    targets.add(std::vector<double>(static_cast<std::size_t>(d), 1e300));
    check_list(targets, targets.size(), sources, 0.3, false);
    NeighbourGrid grid;
    grid.build(sources.positions(), 0.3);
    CHECK_FALSE(grid.map(0).is_uniform());  // the case is about compressed axes
  }
}

TEST_CASE("positions that are not finite are reported and left out") {
  for (int d : {2, 3}) {
    Cloud cloud = random_cloud(d, 500, 0.0, 1.0, 19);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    const auto at = [&](std::size_t i, int a) -> double& {
      return cloud.x[i * static_cast<std::size_t>(d) + static_cast<std::size_t>(a)];
    };
    at(123, d - 1) = nan;
    at(124, 0) = inf;
    at(499, 0) = -inf;
    at(499, 1) = nan;
    at(300, 1) = 1e300;
    NeighbourGrid grid;
    grid.build(cloud.positions(), 0.2);
    CHECK(grid.n_invalid() == 4);
    CHECK(grid.first_invalid() == 123);
    CHECK(grid.n_valid() == 496);
    NeighbourList list;
    list.build(grid, cloud.positions(), 0.2, true);
    for (std::size_t i : {123u, 124u, 499u, 300u}) CHECK(list.counts()[i] == 0);
    check_self(cloud, 0.2);
  }
  Cloud none{2, std::vector<double>(20, std::numeric_limits<double>::quiet_NaN())};
  NeighbourGrid grid;
  grid.build(none.positions(), 0.2);
  CHECK(grid.n_valid() == 0);
  check_self(none, 0.2);
}

TEST_CASE("a row is the same wherever it stands among the others, and however many there are") {
  // Rows are found in blocks: these numbers end before, at and behind the end of one.
  for (int d : {2, 3})
    for (std::size_t n : {1u, 63u, 64u, 65u, 127u, 128u, 129u, 200u}) {
      CAPTURE(d);
      CAPTURE(n);
      const Cloud sources = random_cloud(d, 300, 0.0, 1.0, 24), targets = random_cloud(d, n, -0.3, 1.3, 25);
      check_list(targets, n, sources, 0.21, false);
      check_list(sources, n, sources, 0.21, true);
    }
}

TEST_CASE("rows without a candidate among others, in whole blocks and here and there") {
  for (int d : {2, 3}) {
    Cloud targets{d, {}};
    std::mt19937_64 random(26);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 600; ++i) {
      const double shift = i < 200 ? 50.0 : (i % 3 == 0 ? -20.0 : 0.0);
      std::vector<double> p(static_cast<std::size_t>(d), 0.0);
      for (double& c : p) c = uniform(random);
      p[static_cast<std::size_t>(i % d)] += shift;
      targets.add(p);
    }
    check_list(targets, targets.size(), random_cloud(d, 400, 0.0, 1.0, 27), 0.2, false);
  }
}

TEST_CASE("images of particles across the faces of a periodic box make rows of the nearest images") {
  const double cutoff = 0.17;
  for (int d : {2, 3}) {
    const Cloud owned = random_cloud(d, 400, 0.0, 1.0, 28);
    Cloud all = owned;
    std::vector<std::uint32_t> original(owned.size());
    for (std::uint32_t i = 0; i < original.size(); ++i) original[i] = i;
    for (int image = 0; image < (d == 2 ? 9 : 27); ++image) {
      const int shift[3] = {image % 3 - 1, image / 3 % 3 - 1, d == 2 ? 0 : image / 9 - 1};
      if (shift[0] == 0 && shift[1] == 0 && shift[2] == 0) continue;
      for (std::uint32_t i = 0; i < owned.size(); ++i) {
        std::vector<double> p;
        for (int a = 0; a < d; ++a)
          p.push_back(owned.x[i * static_cast<std::size_t>(d) + static_cast<std::size_t>(a)] + shift[a]);
        if (!std::all_of(p.begin(), p.end(), [&](double c) { return c > -cutoff && c < 1.0 + cutoff; }))
          continue;
        all.add(p);
        original.push_back(i);
      }
    }
    check_list(all, owned.size(), all, cutoff, true);
    NeighbourGrid grid;
    grid.build(all.positions(), cutoff);
    NeighbourList list;
    list.build(grid, {all.x.data(), owned.size(), d}, cutoff, true);
    auto rows = rows_of(list);
    for (auto& row : rows)
      for (std::uint32_t& j : row) j = original[j];
    std::vector<std::vector<std::uint32_t>> expected(owned.size());
    for (std::uint32_t i = 0; i < owned.size(); ++i)
      for (std::uint32_t j = 0; j < owned.size(); ++j) {
        double r2 = 0.0;
        for (std::size_t a = 0; a < static_cast<std::size_t>(d); ++a) {
          double difference =
              owned.x[i * static_cast<std::size_t>(d) + a] - owned.x[j * static_cast<std::size_t>(d) + a];
          difference -= std::round(difference);
          r2 += difference * difference;
        }
        if (i != j && r2 < cutoff * cutoff) expected[i].push_back(j);
      }
    CHECK(sorted_rows(rows) == expected);
  }
}

TEST_CASE("targets that are not finite, or far away, beside any grid") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (int d : {2, 3})
    for (bool compressed : {false, true}) {
      Cloud sources = random_cloud(d, 500, 0.0, 1.0, 29);
      if (compressed)
        for (std::size_t k = sources.x.size() / 2; k < sources.x.size(); ++k) sources.x[k] += 1e5;
      Cloud targets = random_cloud(d, 300, 0.0, 1.0, 30);
      std::size_t next = 0;
      for (double odd : {nan, inf, -inf, 1e300, -1e300, 1e17, -1e17, 5e4, -1.0, 2.0})
        for (int a = 0; a < d; ++a, next += 7)
          targets.x[next * static_cast<std::size_t>(d) + static_cast<std::size_t>(a)] = odd;
      check_list(targets, targets.size(), sources, 0.2, false);
      NeighbourGrid grid;
      grid.build(sources.positions(), 0.2);
      CHECK(grid.map(0).is_uniform() == !compressed);
      NeighbourList list;
      list.build(grid, targets.positions(), 0.2, false);
      for (std::size_t i = 0; i < next; i += 7) CHECK(list.counts()[i] == 0);
    }
}

TEST_CASE("one thread and two give the same list") {
  for (int d : {2, 3}) {
    Cloud cloud = d == 2 ? jittered_lattice(2, 250, 0.01, 0.4, 20) : jittered_lattice(3, 38, 0.01, 0.4, 21);
    std::shuffle(cloud.x.begin(), cloud.x.end(), std::mt19937(1));  // any point of the box is as good
    cloud.x[5] = std::numeric_limits<double>::quiet_NaN();
    NeighbourGrid grids[2];
    NeighbourList lists[2];
    for (std::size_t k : {0u, 1u}) {
      const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, k + 1);
      // A second build reuses the memory of the first, and must not see it.
      for (int repeat = 0; repeat < 2; ++repeat) {
        grids[k].build(cloud.positions(), 0.026);
        lists[k].build(grids[k], cloud.positions(), 0.026, true);
      }
    }
    REQUIRE(grids[0].n_cells() == grids[1].n_cells());
    CHECK(std::equal(grids[0].order(), grids[0].order() + grids[0].n(), grids[1].order()));
    CHECK(std::equal(grids[0].cell_start(), grids[0].cell_start() + grids[0].n_cells() + 1,
                     grids[1].cell_start()));
    for (int a = 0; a < d; ++a)
      CHECK(std::equal(grids[0].sorted(a), grids[0].sorted(a) + grids[0].n_valid(), grids[1].sorted(a)));
    const auto n = cloud.size();
    CHECK(layout_errors(lists[0]) == 0);
    CHECK(std::equal(lists[0].offsets(), lists[0].offsets() + n + 1, lists[1].offsets()));
    CHECK(std::equal(lists[0].counts(), lists[0].counts() + n, lists[1].counts()));
    CHECK(std::equal(lists[0].indices(), lists[0].indices() + lists[0].offsets()[n], lists[1].indices()));
    CHECK(lists[0].n_pairs() == lists[1].n_pairs());
    // and the large build is right: rows of a part of the particles against all pairs
    Cloud part{d, {cloud.x.begin(), cloud.x.begin() + 300 * d}};
    auto expected = all_pairs(part, 300, cloud, 0.026, true);
    auto rows = sorted_rows(rows_of(lists[1]));
    rows.resize(300);
    CHECK(rows == expected);
  }
}

TEST_CASE("memory is kept between builds and grows with the list") {
  const Cloud cloud = jittered_lattice(3, 20, 0.01, 0.2, 22);
  NeighbourGrid grid;
  NeighbourList list;
  grid.build(cloud.positions(), 0.026);
  list.build(grid, cloud.positions(), 0.026, true);
  const std::size_t bytes = list.memory_bytes(), grid_bytes = grid.memory_bytes();
  const std::uint32_t* indices = list.indices();
  CHECK(bytes >= list.offsets()[list.n_rows()] * 4 + list.n_rows() * 12);
  CHECK(bytes < 1.2 * static_cast<double>(list.offsets()[list.n_rows()] * 4 + list.n_rows() * 12));
  for (int repeat = 0; repeat < 3; ++repeat) {
    grid.build(cloud.positions(), 0.026);
    list.build(grid, cloud.positions(), 0.026, true);
  }
  CHECK(list.memory_bytes() == bytes);
  CHECK(grid.memory_bytes() == grid_bytes);
  CHECK(list.indices() == indices);
  grid.build(cloud.positions(), 0.04);
  list.build(grid, cloud.positions(), 0.04, true);
  CHECK(list.memory_bytes() > 2 * bytes);
  CHECK(layout_errors(list) == 0);
}

TEST_CASE("arguments that make no sense are refused") {
  const Cloud cloud = random_cloud(3, 10, 0.0, 1.0, 23), flat = random_cloud(2, 10, 0.0, 1.0, 23);
  NeighbourGrid grid;
  CHECK_THROWS_AS(grid.build(cloud.positions(), 0.0), std::invalid_argument);
  CHECK_THROWS_AS(grid.build(cloud.positions(), std::numeric_limits<double>::quiet_NaN()),
                  std::invalid_argument);
  grid.build(cloud.positions(), 0.5);
  NeighbourList list;
  CHECK_THROWS_AS(list.build(grid, cloud.positions(), 0.6, true), std::invalid_argument);
  CHECK_THROWS_AS(list.build(grid, flat.positions(), 0.5, false), std::invalid_argument);
  const Cloud more = random_cloud(3, 20, 0.0, 1.0, 23);
  CHECK_THROWS_AS(list.build(grid, more.positions(), 0.5, true), std::invalid_argument);
}
