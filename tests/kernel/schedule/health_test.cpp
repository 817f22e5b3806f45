// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What stops a run, and what it says then.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hand_made.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

// Sets one component of a field at the particles with these ids in step 3, through an operator that knows ids only
// as initial order (the body does not move and is not sorted).
Operator spoiler(const char* field, shoal_rank rank, std::vector<std::pair<std::uint64_t, double>> values) {
  Operator op;
  op.name = "test.spoiler";
  op.flags = SHOAL_OPERATOR_SERIAL;
  op.access(field, SHOAL_READ | SHOAL_WRITE, rank);
  op.run = [values](const Views& views, const shoal_step& step, const shoal_chunk&) {
    if (step.number == 3)
      for (const auto& [index, value] : values) views.real(0)[index] = value;
    return SHOAL_OK;
  };
  return op;
}

PhysicsFailure::Report failure_of(const std::function<void(const Physics&)>& declare,
                                  SimulationSettings what = settings(2, 1.0), std::vector<int> n = {10, 8}) {
  Simulation run(what);
  run.add_body(lattice("water", 2, n, 0.1));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.1));
  declare(physics);
  run.finalise();
  run.initialise();
  try {
    while (!run.finished()) run.step();
  } catch (const PhysicsFailure& failure) {
    CHECK(std::string(failure.what()).find(failure.report().cause) == 0);
    return failure.report();
  }
  return {};
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a guard names the five worst particles") {
  for (const int n : {10, 1000}) {
    const auto report = failure_of(
        [](const Physics& physics) {
          physics.guard(0, "density", -10.0, 10.0);
          physics.attach(
              "main", "all",
              spoiler("density", SHOAL_SCALAR,
                      {{3, 10.5}, {7, -90.0}, {11, 11.0}, {12, 12.0}, {13, 13.0}, {14, 14.0}, {20, 10.0}}));
        },
        settings(2, 1.0), {n, 8});
    CHECK(report.cause == "field 'density' of body 'water' is outside [-10, 10] at 6 particles");
    CHECK(report.loop == "main");
    CHECK(report.step == 4);
    CHECK(report.time == doctest::Approx(0.4));
    REQUIRE(report.worst.size() == 5);
    CHECK(report.worst[0].id == 7);
    CHECK(report.worst[0].value == -90.0);
    CHECK(report.worst[0].field == "density");
    CHECK(report.worst[0].body == "water");
    CHECK(report.worst[0].position[0] == doctest::Approx(0.05));
    CHECK(report.worst[0].position[1] == doctest::Approx(0.75));
    CHECK(report.worst[1].id == 14);
    CHECK(report.worst[4].id == 11);
  }
}

TEST_CASE("every particle and component is looked at") {
  // The fast pass works on groups of eight; the last group is not full.
  for (const std::uint64_t index : {0u, 1u, 7u, 8u, 63u, 64u, 70u, 71u, 79u, 80u, 145u, 153u, 159u}) {
    const auto report = failure_of([&](const Physics& physics) {
      physics.attach("main", "all", spoiler("velocity", SHOAL_RANK_VECTOR, {{index, not_a_number}}));
    });
    CHECK(report.cause == "field 'velocity' of body 'water' is not a finite number at 1 particle");
    REQUIRE(report.worst.size() == 1);
    CHECK(report.worst[0].id == static_cast<std::int64_t>(index / 2));
  }
  CHECK(failure_of([](const Physics& physics) {
          physics.attach("main", "all", spoiler("velocity", SHOAL_RANK_VECTOR, {{5, 1e300}}));
        }).cause.empty());
  CHECK(failure_of([](const Physics& physics) {
          physics.attach(
              "main", "all",
              spoiler("velocity", SHOAL_RANK_VECTOR, {{5, std::numeric_limits<double>::infinity()}}));
        }).cause == "field 'velocity' of body 'water' is not a finite number at 1 particle");
}

TEST_CASE("a particle outside the domain has escaped") {
  const auto place = [](double x, SimulationSettings what = settings(2, 1.0)) {
    return failure_of(
               [&](const Physics& physics) {
                 physics.attach("main", "all", spoiler("position", SHOAL_RANK_VECTOR, {{2 * 17, x}}));
               },
               what)
        .cause;
  };
  const std::string escaped = "1 particle of body 'water' has left the domain";
  // The lattice covers 0.05 to 0.95 along x: without a domain, 0.9 beyond is allowed.
  CHECK(place(1.8) == "");
  CHECK(place(1.9) == escaped);
  CHECK(place(-0.8) == "");
  CHECK(place(-0.9) == escaped);
  CHECK(place(not_a_number) == "field 'position' of body 'water' is not a finite number at 1 particle");
  SimulationSettings what = settings(2, 1.0);
  what.lower[0] = -0.2;
  CHECK(place(-0.1, what) == "");
  CHECK(place(-0.3, what) == escaped);
  CHECK(place(1.8, what) == "");
  // A periodic axis cannot be left.
  what.upper[0] = 1.0;
  what.boundaries[0] = {BoundaryKind::periodic, BoundaryKind::periodic};
  CHECK(place(1.9, what) == "");
}

TEST_CASE("particles that start outside are an error of the case") {
  SimulationSettings what = settings(2, 1.0);
  what.lower[1] = 0.1;
  Simulation run(what);
  run.add_body(lattice("water", 2, {3, 3}, 0.1));
  Physics(run).loop("main", {"all"});
  run.finalise();
  const std::string message = message_of([&] { run.initialise(); });
  CHECK(message.find("before the first step: 3 particles of body 'water' have left the domain") == 0);
}

TEST_CASE("a step that collapses names its operator and the particles that asked for it") {
  for (const int n : {10, 1000}) {
    Operator op;
    op.name = "test.signal_speed";
    op.flags = SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES;
    op.access("velocity", SHOAL_READ, SHOAL_RANK_VECTOR);
    op.time_step = [](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
      double limit = 0.1;
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        limit = std::min(limit, 0.1 / std::abs(views.real(0)[2 * i]));
      return limit;
    };
    const auto report = failure_of(
        [&](const Physics& physics) {
          physics.attach("main", "all", op);
          physics.attach("main", "all",
                         spoiler("velocity", SHOAL_RANK_VECTOR, {{2 * 29, 1e8}, {2 * 31, 100.0}}));
        },
        settings(2, 1.0), {n, 8});
    CHECK(report.cause ==
          "operator test.signal_speed on body 'water' allows a step of only 1e-09 s, after steps of up to "
          "0.1 s: it has "
          "collapsed");
    CHECK(report.loop == "main");
    CHECK(report.step == 4);
    REQUIRE(report.worst.size() == 5);
    CHECK(report.worst[0].id == 29);
  }
  for (const double limit : {0.0, -1.0, not_a_number})
    CHECK(failure_of([&](const Physics& physics) {
            physics.attach("main", "all", limiter(limit, "test.bad"));
          }).cause.find("which is not a positive number") != std::string::npos);
}

TEST_CASE("steps shrink by less than the fraction of a collapse without complaint") {
  Operator op;
  op.name = "test.shrinking";
  op.time_step = [](const Views&, const shoal_step& step, const shoal_chunk&) {
    return step.number < 3 ? 0.1 : 2e-7;
  };
  SimulationSettings what = settings(2, 0.300001);
  CHECK(failure_of([&](const Physics& physics) { physics.attach("main", "all", op); }, what).cause.empty());
}

TEST_CASE("contradictory domains are refused") {
  const auto make = [](const std::function<void(SimulationSettings&)>& change) {
    return message_of([&] {
      SimulationSettings what = settings(2, 1.0);
      change(what);
      Simulation run(what);
    });
  };
  CHECK(make([](SimulationSettings&) {}) == "no error");
  CHECK(make([](SimulationSettings& what) { what.dimensions = 4; }) == "a run has 2 or 3 dimensions, not 4");
  CHECK(make([](SimulationSettings& what) { what.boundaries[1].lower = BoundaryKind::periodic; }) ==
        "the domain is periodic at one face of axis y only; it must be at both");
  CHECK(make([](SimulationSettings& what) { what.boundaries[1].upper = BoundaryKind::mirror; }) ==
        "the domain's upper face along y is not open, so it needs a place");
  CHECK(make([](SimulationSettings& what) {
          what.lower[0] = 1.0;
          what.upper[0] = 0.0;
        }) == "the domain's lower face along x is not below its upper face");
}
