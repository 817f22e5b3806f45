// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Relations in a running simulation against double loops over all particles and all their images: moving, wrapped,
// re-sorted, periodic, mirrored.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "hand_made.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

constexpr auto open = BoundaryKind::open;
constexpr auto periodic = BoundaryKind::periodic;
constexpr auto mirror = BoundaryKind::mirror;

double weight(double r, double cutoff) { return r < cutoff ? (cutoff - r) * (cutoff - r) : 0.0; }

// sum_i += sum_j W(r) (s_j + v_j . (x_i - x_j)): uses positions, a scalar and a vector of the neighbours.
Operator pair_sum(std::uint32_t body, std::uint32_t neighbours, double cutoff,
                  shoal_configuration configuration = SHOAL_CURRENT) {
  Operator op;
  op.name = "test.pair_sum";
  op.body = body;
  const bool reference = configuration == SHOAL_REFERENCE;
  op.access(reference ? "reference_position" : "position", SHOAL_READ | SHOAL_OF_NEIGHBOURS,
            SHOAL_RANK_VECTOR)
      .access("velocity", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
      .access("temperature", SHOAL_READ | SHOAL_OF_NEIGHBOURS)
      .access(reference ? "reference_sum" : "sum", SHOAL_WRITE)
      .relation(neighbours, cutoff, configuration);
  op.run = [cutoff](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
    const auto d = static_cast<std::uint64_t>(step.dimensions);
    const shoal_neighbours& list = views.neighbours[0];
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      double sum = 0.0;
      for (std::uint32_t k = 0; k < list.counts[i]; ++k) {
        const std::uint64_t j = list.indices[list.offsets[i] + k];
        double square = 0.0, projection = 0.0;
        for (std::uint64_t a = 0; a < d; ++a) {
          const double x = views.real(0)[i * d + a] - views.neighbour_real(0, 0)[j * d + a];
          square += x * x;
          projection += x * views.neighbour_real(0, 1)[j * d + a];
        }
        sum += weight(std::sqrt(square), cutoff) * (views.neighbour_real(0, 2)[j] + projection);
      }
      views.real(3)[i] = sum;
    }
    return SHOAL_OK;
  };
  return op;
}

// The same sum over all particles of another body and all repetitions and reflections of the domain.
std::vector<double> brute_force(const SimulationSettings& what, const double* x, std::uint64_t n,
                                const double* y, const double* v, const double* s, std::uint64_t m, bool same,
                                double cutoff) {
  struct Map {
    double sign, shift;
  };
  std::vector<Map> maps[3];
  const int d = what.dimensions;
  for (int a = 0; a < 3; ++a) {
    maps[a].push_back({1.0, 0.0});
    if (a >= d) continue;
    if (what.boundaries[a].lower == periodic)
      for (int k = 1; k <= 3; ++k) {
        maps[a].push_back({1.0, k * (*what.upper[a] - *what.lower[a])});
        maps[a].push_back({1.0, -k * (*what.upper[a] - *what.lower[a])});
      }
    if (what.boundaries[a].lower == mirror) maps[a].push_back({-1.0, 2.0 * *what.lower[a]});
    if (what.boundaries[a].upper == mirror) maps[a].push_back({-1.0, 2.0 * *what.upper[a]});
  }
  std::vector<double> sums(n, 0.0);
  for (std::uint64_t i = 0; i < n; ++i)
    for (std::uint64_t j = 0; j < m; ++j)
      for (const Map& mx : maps[0])
        for (const Map& my : maps[1])
          for (const Map& mz : maps[2]) {
            const Map map[3] = {mx, my, mz};
            double square = 0.0, projection = 0.0;
            bool itself = same && i == j;
            for (int a = 0; a < d; ++a) {
              const auto k = static_cast<std::uint64_t>(a), D = static_cast<std::uint64_t>(d);
              const double r = x[i * D + k] - (map[a].sign * y[j * D + k] + map[a].shift);
              itself = itself && map[a].sign > 0.0 && map[a].shift == 0.0;
              square += r * r;
              projection += r * map[a].sign * v[j * D + k];
            }
            if (!itself) sums[i] += weight(std::sqrt(square), cutoff) * (s[j] + projection);
          }
  return sums;
}

struct Scene {
  int dimensions;
  std::array<BoundaryKind, 3> kinds;
  int particles_per_side;
};

BodySpecification random_body(const char* name, const Scene& scene, double dx, unsigned seed, double speed) {
  std::vector<int> n(3, scene.particles_per_side);
  BodySpecification body = lattice(name, scene.dimensions, n, dx);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shake(-0.3 * dx, 0.3 * dx), unit(-1.0, 1.0);
  for (double& x : body.positions) x += shake(random);
  const int d = scene.dimensions;
  std::vector<double> velocities, temperatures;
  for (std::size_t k = 0; k < body.positions.size(); ++k) velocities.push_back(speed * unit(random));
  for (std::size_t k = 0; k < body.positions.size() / static_cast<std::size_t>(d); ++k)
    temperatures.push_back(unit(random));
  body.initial_fields.push_back({"velocity", SHOAL_RANK_VECTOR,
                                 [velocities](std::uint64_t, const double*, double* out) {
                                   std::copy(velocities.begin(), velocities.end(), out);
                                 },
                                 ""});
  body.initial_fields.push_back({"temperature", SHOAL_SCALAR,
                                 [temperatures](std::uint64_t, const double*, double* out) {
                                   std::copy(temperatures.begin(), temperatures.end(), out);
                                 },
                                 ""});
  return body;
}

const double* reals(const Simulation& run, std::uint32_t body, const char* field) {
  return static_cast<const double*>(run.field(body, field).data);
}

SimulationSettings scene_settings(const Scene& scene, int threads) {
  SimulationSettings what = settings(scene.dimensions, 10.0);
  what.threads = threads;
  for (int a = 0; a < scene.dimensions; ++a) {
    const BoundaryKind kind = scene.kinds[static_cast<std::size_t>(a)];
    what.boundaries[a] = {kind, kind};
    // Open sides are far away, so that the whole test happens inside.
    what.lower[a] = kind == open ? -50.0 : 0.0;
    what.upper[a] = kind == open ? 50.0 : scene.particles_per_side * 0.1;
  }
  what.sort_interval = 3;
  return what;
}

void check_against_brute_force(const Scene& scene) {
  const SimulationSettings what = scene_settings(scene, 2);
  const double cutoff = 0.26;
  Simulation run(what);
  // Slow against mirrors, which particles are not to cross; else fast enough to leave the box.
  const bool mirrored = std::count(scene.kinds.begin(), scene.kinds.end(), mirror) > 0;
  run.add_body(random_body("a", scene, 0.1, 1, mirrored ? 0.001 : 0.4));
  Scene coarse = scene;
  coarse.particles_per_side = scene.particles_per_side / 2;
  run.add_body(random_body("b", coarse, 0.2, 2, 0.0));
  const Physics physics(run);
  physics.loop("main", {"sums", "move"});
  physics.renew_neighbours_in("main");
  physics.body_moves(0);
  physics.attach("main", "sums", limiter(0.1));
  physics.attach("main", "sums", pair_sum(0, 0, cutoff));
  Operator other = pair_sum(0, 1, 0.45);
  other.accesses[3].field = "sum_of_b";
  physics.attach("main", "sums", other);
  physics.attach("main", "sums", pair_sum(1, 0, 0.45));
  physics.attach("main", "move", mover(0));
  // Keeps the positions that the sums have seen.
  Operator keep;
  keep.name = "test.keep";
  keep.access("position", SHOAL_READ, SHOAL_RANK_VECTOR).access("seen", SHOAL_WRITE, SHOAL_RANK_VECTOR);
  keep.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
    const auto d = static_cast<std::uint64_t>(step.dimensions);
    std::copy(views.real(0) + chunk.begin * d, views.real(0) + chunk.end * d,
              views.real(1) + chunk.begin * d);
    return SHOAL_OK;
  };
  physics.attach("main", "sums", keep);
  run.finalise();
  run.initialise();
  const std::uint64_t n = run.n_particles(0), m = run.n_particles(1);
  for (int step = 0; step < 7; ++step) {
    run.step();
    const double *x = reals(run, 0, "seen"), *v = reals(run, 0, "velocity"),
                 *s = reals(run, 0, "temperature");
    const double *y = reals(run, 1, "position"), *w = reals(run, 1, "velocity"),
                 *t = reals(run, 1, "temperature");
    const auto compare = [&](const std::vector<double>& expected, const double* found) {
      double worst = 0.0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        worst = std::max(worst, std::isnan(found[i]) ? 1e9 : std::abs(expected[i] - found[i]));
      CHECK(worst < 1e-12);
    };
    // The list of a relation reaches as far as any of its users asked; weights end at their own cut-off.
    compare(brute_force(what, x, n, x, v, s, n, true, cutoff), reals(run, 0, "sum"));
    compare(brute_force(what, x, n, y, w, t, m, false, 0.45), reals(run, 0, "sum_of_b"));
    compare(brute_force(what, y, m, x, v, s, n, false, 0.45), reals(run, 1, "sum"));
  }
  CHECK(run.timings().sorts == 3);
}

}  // namespace

TEST_CASE("pair sums across boundaries, in two dimensions") {
  check_against_brute_force({2, {open, open, open}, 14});
  check_against_brute_force({2, {periodic, open, open}, 14});
  check_against_brute_force({2, {periodic, periodic, open}, 14});
  check_against_brute_force({2, {mirror, periodic, open}, 14});
  check_against_brute_force({2, {mirror, mirror, open}, 14});
}

TEST_CASE("pair sums across boundaries, in three dimensions") {
  check_against_brute_force({3, {periodic, periodic, periodic}, 6});
  check_against_brute_force({3, {periodic, mirror, open}, 6});
  check_against_brute_force({3, {mirror, mirror, mirror}, 6});
}

TEST_CASE("re-sorting keeps ids and values together and changes no result") {
  // Two runs, one re-sorted at every renewal, one never again: the same particles have the same values.
  const Scene scene{2, {periodic, periodic, open}, 80};
  std::map<std::int64_t, std::array<double, 4>> values[2];
  for (const int which : {0, 1}) {
    SimulationSettings what = scene_settings(scene, 2);
    what.sort_interval = which == 0 ? 1 : 1000;
    Simulation run(what);
    run.add_body(random_body("a", scene, 0.1, 3, 1.0));
    const Physics physics(run);
    physics.loop("main", {"all"});
    physics.body_moves(0);
    physics.attach("main", "all", limiter(0.2));
    physics.attach("main", "all", pair_sum(0, 0, 0.26));
    physics.attach("main", "all", mover(0));
    run.finalise();
    run.initialise();
    for (int k = 0; k < 10; ++k) run.step();
    CHECK(run.timings().sorts == (which == 0 ? 10 : 1));
    for (std::uint64_t i = 0; i < run.n_particles(0); ++i)
      values[which][run.ids(0)[i]] = {reals(run, 0, "position")[2 * i], reals(run, 0, "position")[2 * i + 1],
                                      reals(run, 0, "temperature")[i], reals(run, 0, "sum")[i]};
  }
  REQUIRE(values[0].size() == 6400);
  double worst_state = 0.0, worst_sum = 0.0;
  for (const auto& [id, value] : values[0]) {
    const auto& other = values[1].at(id);
    for (std::size_t k = 0; k < 3; ++k) worst_state = std::max(worst_state, std::abs(value[k] - other[k]));
    worst_sum = std::max(worst_sum, std::abs(value[3] - other[3]));
  }
  CHECK(worst_state == 0.0);
  CHECK(worst_sum < 1e-13);  // neighbours are summed in another order
}

TEST_CASE("results do not depend on the number of threads, bit by bit") {
  const Scene scene{2, {periodic, mirror, open}, 90};
  std::vector<double> sums[3];
  for (const int threads : {1, 2, 4}) {
    Simulation run(scene_settings(scene, threads));
    run.add_body(random_body("a", scene, 0.1, 3, 0.001));
    const Physics physics(run);
    physics.loop("main", {"all"});
    physics.body_moves(0);
    physics.attach("main", "all", limiter(0.2));
    physics.attach("main", "all", pair_sum(0, 0, 0.26));
    physics.attach("main", "all", mover(0));
    run.finalise();
    run.initialise();
    for (int k = 0; k < 8; ++k) run.step();
    std::vector<double>& mine = sums[threads / 2];
    mine.assign(reals(run, 0, "sum"), reals(run, 0, "sum") + run.n_particles(0));
    mine.insert(mine.end(), reals(run, 0, "position"), reals(run, 0, "position") + 2 * run.n_particles(0));
  }
  CHECK(sums[0] == sums[1]);
  CHECK(sums[0] == sums[2]);
}

TEST_CASE("images follow inside a sub-cycled loop, also while neighbours are not renewed") {
  const Scene scene{2, {periodic, open, open}, 10};
  const SimulationSettings what = scene_settings(scene, 1);
  Simulation run(what);
  run.add_body(random_body("a", scene, 0.1, 5, 0.01));
  const Physics physics(run);
  physics.loop("outer", {"all"});
  physics.loop("inner", {"all"}, "outer", "all");
  physics.renew_neighbours_in("outer");
  physics.attach("outer", "all", limiter(1.0));
  physics.attach("inner", "all", limiter(0.2));
  physics.attach("inner", "all", mover(0));
  physics.attach("inner", "all", pair_sum(0, 0, 0.26));
  run.finalise();
  run.initialise();
  run.step();
  CHECK(run.timings().renewals == 2);
  CHECK(run.timings().halo_values > 0.0);
  const double *x = reals(run, 0, "position"), *v = reals(run, 0, "velocity"),
               *s = reals(run, 0, "temperature");
  // Pairs that came near since the renewal are missing; displacements of 0.01 change few weights near the cut-off.
  const std::vector<double> expected = brute_force(what, x, 100, x, v, s, 100, true, 0.26);
  double worst = 0.0;
  for (std::size_t i = 0; i < 100; ++i)
    worst = std::max(worst, std::abs(expected[i] - reals(run, 0, "sum")[i]));
  CHECK(worst < 2e-3);
}

TEST_CASE("lists between bodies that do not move are built once; of the others in every renewal") {
  const Scene scene{2, {open, open, open}, 8};
  Simulation run(scene_settings(scene, 1));
  run.add_body(random_body("moving", scene, 0.1, 1, 0.1));
  run.add_body(random_body("still", scene, 0.1, 2, 0.1));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.1));
  physics.attach("main", "all", pair_sum(0, 0, 0.26));
  physics.attach("main", "all", pair_sum(1, 1, 0.26));
  physics.attach("main", "all", mover(0));
  Operator cross = pair_sum(1, 0, 0.2);
  cross.accesses[3].field = "cross";
  physics.attach("main", "all", cross);
  cross.relations[0].cutoff = 0.3;  // shares the list
  cross.accesses[3].field = "cross_again";
  physics.attach("main", "all", cross);
  run.finalise();
  run.initialise();
  for (int k = 0; k < 5; ++k) run.step();
  const Plan plan = run.plan();
  REQUIRE(plan.relations.size() == 3);
  CHECK(plan.relations[0].builds == 5);
  CHECK(plan.relations[1].builds == 1);
  CHECK(plan.relations[2].builds == 5);
  CHECK(plan.relations[2].cutoff == 0.3);
}

TEST_CASE("reference relations keep their pairs while particles move, also across boundaries") {
  for (const BoundaryKind kind : {open, periodic, mirror}) {
    const Scene scene{2, {kind, periodic, open}, 10};
    const SimulationSettings what = scene_settings(scene, 2);
    Simulation run(what);
    run.add_body(random_body("solid", scene, 0.1, 1, 0.02));
    const Physics physics(run);
    physics.loop("main", {"all"});
    physics.body_moves(0);
    physics.attach("main", "all", limiter(0.1));
    physics.attach("main", "all", pair_sum(0, 0, 0.26, SHOAL_REFERENCE));
    physics.attach("main", "all", pair_sum(0, 0, 0.31));
    physics.attach("main", "all", mover(0));
    run.finalise();
    run.initialise();
    for (int k = 0; k < 7; ++k) run.step();
    const double *x = reals(run, 0, "reference_position"), *v = reals(run, 0, "velocity"),
                 *s = reals(run, 0, "temperature");
    const std::vector<double> expected = brute_force(what, x, 100, x, v, s, 100, true, 0.26);
    double worst = 0.0;
    for (std::size_t i = 0; i < 100; ++i) {
      const double found = reals(run, 0, "reference_sum")[i];
      worst = std::max(worst, std::isnan(found) ? 1e9 : std::abs(expected[i] - found));
    }
    CHECK(worst < 1e-13);
    CHECK(run.plan().relations[0].builds == 1);
    CHECK(run.timings().sorts == 1);  // before the reference lists were built, and never again
  }
}

TEST_CASE("what was not declared to be read of neighbours is NaN in their images") {
  const Scene scene{2, {periodic, periodic, open}, 6};
  Simulation run(scene_settings(scene, 1));
  run.add_body(random_body("a", scene, 0.1, 1, 0.02));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.1));
  bool undeclared_is_nan = true, declared_is_finite = true;
  Operator op;
  op.access("temperature", SHOAL_READ)
      .access("velocity", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
      .relation(0, 0.26);
  op.run = [&](const Views& views, const shoal_step&, const shoal_chunk&) {
    CHECK(views.own[0].n_total > views.own[0].n_owned);
    CHECK(views.of_neighbours[0].data == nullptr);
    for (std::uint64_t i = views.own[0].n_owned; i < views.own[0].n_total; ++i) {
      undeclared_is_nan = undeclared_is_nan && std::isnan(views.real(0)[i]);
      declared_is_finite = declared_is_finite && std::isfinite(views.real(1)[2 * i]);
    }
    return SHOAL_OK;
  };
  physics.attach("main", "all", op);
  physics.attach("main", "all", mover(0));
  run.finalise();
  run.initialise();
  for (int k = 0; k < 3; ++k) run.step();
  CHECK(undeclared_is_nan);
  CHECK(declared_is_finite);
}
