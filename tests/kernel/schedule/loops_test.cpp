// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree of loops: which step follows which, how long it is, and what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hand_made.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

Operator recorder(const char* name, std::vector<shoal_step>& steps) {
  Operator op;
  op.name = name;
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.begin = [&steps](const shoal_step& step) {
    steps.push_back(step);
    return SHOAL_OK;
  };
  return op;
}

}  // namespace

TEST_CASE("a child covers its parent's step in equal steps, recomputed each time") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("outer", {"first", "inner", "last"});
  physics.loop("inner", {"work"}, "outer", "inner");
  std::vector<shoal_step> outer, inner;
  std::vector<char> order;
  physics.attach("outer", "first", limiter(0.3));
  physics.attach("inner", "work", limiter(0.08));
  Operator first = recorder("test.first", outer);
  first.end = [&](const shoal_step&, const double*) { return order.push_back('f'), SHOAL_OK; };
  Operator work = recorder("test.work", inner);
  work.end = [&](const shoal_step&, const double*) { return order.push_back('w'), SHOAL_OK; };
  Operator last;
  last.name = "test.last";
  last.end = [&](const shoal_step&, const double*) { return order.push_back('l'), SHOAL_OK; };
  physics.attach("outer", "last", last);
  physics.attach("outer", "first", first);
  physics.attach("inner", "work", work);
  run.finalise();
  run.initialise();
  run.step();
  CHECK(std::string(order.begin(), order.end()) == "fwwwwl");
  CHECK(outer.size() == 1);
  CHECK(outer[0].dt == 0.3);
  CHECK(outer[0].parent_dt == 0.3);
  CHECK(outer[0].time == 0.0);
  REQUIRE(inner.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(inner[k].dt == doctest::Approx(0.075));
    CHECK(inner[k].time == doctest::Approx(0.075 * static_cast<double>(k)));
    CHECK(inner[k].number == k);
    CHECK(inner[k].parent_dt == 0.3);
    CHECK(inner[k].parent_time == 0.0);
  }
  while (!run.finished()) run.step();
  // 0.3, 0.3, then the remaining 0.4 in two: no tiny last step.
  REQUIRE(outer.size() == 4);
  CHECK(outer[2].dt == doctest::Approx(0.2));
  CHECK(outer[3].dt == doctest::Approx(0.2));
  CHECK(run.time() == 1.0);
  CHECK(run.outer_steps() == 4);
  CHECK(run.loop_steps("inner") == 4 + 4 + 3 + 3);
  double covered = 0.0;
  for (const shoal_step& step : inner) covered += step.dt;
  CHECK(covered == doctest::Approx(1.0).epsilon(1e-14));
  // A parent's time and its child's agree to the last bit at the parent's next step.
  CHECK(outer[1].time == inner[4].time);
  CHECK(outer[3].time == inner[11].time);
}

TEST_CASE("a limit that shrinks inside the parent's step is obeyed at once") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("outer", {"all"});
  physics.loop("inner", {"work"}, "outer", "all");
  physics.attach("outer", "all", limiter(1.0));
  std::vector<double> limits = {0.5, 0.1};
  std::vector<shoal_step> steps;
  Operator op = recorder("test.work", steps);
  std::size_t asked = 0;
  op.time_step = [&](const Views&, const shoal_step&, const shoal_chunk& chunk) {
    CHECK(chunk.begin == chunk.end);
    return limits[std::min<std::size_t>(asked++, 1)];
  };
  physics.attach("inner", "work", op);
  run.finalise();
  run.initialise();
  run.step();
  REQUIRE(steps.size() == 6);
  CHECK(steps[0].dt == 0.5);
  for (std::size_t k = 1; k < 6; ++k) CHECK(steps[k].dt == doctest::Approx(0.1));
}

TEST_CASE("loops side by side share the largest of their steps") {
  Simulation run(settings(2, 10.0));
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("slow", {"all"});
  physics.loop("fast", {"all"});
  physics.loop("free", {"all"});
  std::vector<shoal_step> slow, fast, free;
  physics.attach("slow", "all", limiter(1.0));
  physics.attach("fast", "all", limiter(0.3));
  physics.attach("slow", "all", recorder("test.slow", slow));
  physics.attach("fast", "all", recorder("test.fast", fast));
  physics.attach("free", "all", recorder("test.free", free));
  run.finalise();
  run.initialise();
  run.step();
  CHECK(run.time() == 1.0);
  CHECK(slow.size() == 1);
  CHECK(free.size() == 1);
  REQUIRE(fast.size() == 4);
  CHECK(fast[1].dt == doctest::Approx(0.25));
  CHECK(fast[1].parent_dt == fast[1].dt);
}

TEST_CASE("time step factors, no_later_than, and runs that nothing limits") {
  SimulationSettings what = settings(2, 2.0);
  what.time_step_factors["main"] = 0.5;
  Simulation run(what);
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(1.0));
  run.finalise();
  run.initialise();
  run.step(0.2);
  CHECK(run.time() == 0.2);
  run.step();
  CHECK(run.last_outer_dt() == 0.5);
  run.step(0.1);  // in the past
  CHECK(run.time() == 0.7);
  CHECK(run.last_dt("main") == 0.5);

  Simulation unlimited(settings(2, 2.0));
  unlimited.add_body(lattice("b", 2, {2, 2}, 1.0));
  Physics(unlimited).loop("main", {"all"});
  unlimited.finalise();
  unlimited.initialise();
  unlimited.step();
  CHECK(unlimited.time() == doctest::Approx(0.002));
}

TEST_CASE("a later call moves a top loop into another, and adds stages where they belong") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("structure", {"stress", "move"});
  physics.loop("structure", {}, "acoustic", "solid");  // before its parent is declared
  physics.loop("acoustic", {"force", "update"});
  physics.loop("acoustic", {"force", "solid", "update"});
  physics.loop("acoustic", {"before", "force"});
  run.finalise();
  CHECK(run.loop_names() == std::vector<std::string>{"acoustic", "structure"});
  const Plan plan = run.plan();
  REQUIRE(plan.loops.size() == 1);
  std::vector<std::string> stages;
  for (const PlanStage& stage : plan.loops[0].stages) stages.push_back(stage.name);
  CHECK(stages == std::vector<std::string>{"before", "force", "solid", "update"});
  CHECK(plan.loops[0].stages[2].loops[0].name == "structure");
}

TEST_CASE("names that nobody declares are answered with those that exist") {
  const auto finalise = [](const std::function<void(const Physics&)>& declare) {
    return message_of([&] {
      SimulationSettings what = settings(2, 1.0);
      Simulation run(what);
      run.add_body(lattice("water", 2, {2, 2}, 1.0));
      run.set_declarer("test.physics");
      const Physics physics(run);
      physics.loop("main", {"force", "move"});
      declare(physics);
      run.finalise();
    });
  };
  CHECK(finalise([](const Physics&) {}) == "no error");
  CHECK(finalise([](const Physics& physics) { physics.attach("mian", "force", limiter(1.0)); }) ==
        "operator test.limit on body 'water' names loop 'mian', which nobody declares; loops of this run: "
        "'main'");
  CHECK(finalise([](const Physics& physics) { physics.attach("main", "forces", limiter(1.0)); }) ==
        "operator test.limit on body 'water' names stage 'forces' of loop 'main', which has none of that "
        "name; its "
        "stages: 'force' and 'move'");
  CHECK(
      finalise([](const Physics& physics) { physics.loop("inner", {}, "outer", "all"); }) ==
      "loop 'inner' (test.physics) names loop 'outer', which nobody declares; loops of this run: 'main' and "
      "'inner'");
  CHECK(finalise([](const Physics& physics) {
          physics.loop("a", {"s"}, "b", "s");
          physics.loop("b", {"s"}, "a", "s");
        }) == "loop 'a' is inside itself; loops of this run: 'main', 'a' and 'b'");
  CHECK(finalise([](const Physics& physics) { physics.loop("initial", {"s"}); }) ==
        "test.physics: no loop can be called 'initial'; that is a stage outside the loops");
  CHECK(finalise([](const Physics& physics) { physics.renew_neighbours_in("advection"); }) ==
        "test.physics (renewal of neighbours) names loop 'advection', which nobody declares; loops of this "
        "run: "
        "'main'");
  CHECK(finalise([](const Physics& physics) {
          physics.loop("child", {"s"}, "main", "force");
          physics.loop("child", {"s"}, "main", "move");
        }) == "loop 'child' is inside main.force for test.physics, but inside main.move for test.physics");
  CHECK(finalise([](const Physics& physics) { physics.attach(nullptr, nullptr, limiter(1.0)); }) ==
        "operator test.limit on body 'water' names no stage and adds to no field that anybody owns there; "
        "owned fields "
        "of that body: none");
  CHECK(finalise([](const Physics& physics) {
          Operator op = limiter(1.0);
          op.body = 3;
          physics.attach("main", "force", op);
        }) == "test.physics: operator test.limit names body 3, but there are only 1");
  CHECK(finalise([](const Physics& physics) {
          physics.own_field(0, "acceleration", "main", "force");
          physics.own_field(0, "acceleration", "main", "move");
        }) ==
        "field 'acceleration' of body 'water' is owned by test.physics in main.force, and by test.physics in "
        "main.move; only one of them can clear it");
}

TEST_CASE("an operator that is refused is destroyed all the same, and every other one once") {
  int destroyed = 0;
  {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("water", 2, {2, 2}, 1.0));
    const Physics physics(run);
    physics.loop("main", {"force"});
    Operator op = limiter(1.0);
    op.destroy = [&] { ++destroyed; };
    op.body = 7;
    CHECK_THROWS_AS(physics.attach("main", "force", op), ModelError);
    CHECK(destroyed == 1);
    op.body = 0;
    physics.attach("main", "force", op);
    op.flags = SHOAL_OPERATOR_ON_DEMAND;
    physics.attach("main", "force", op);
    run.finalise();
    run.initialise();
    CHECK(run.plan().unscheduled == std::vector<std::string>{"test.limit on water"});
  }
  CHECK(destroyed == 3);
}

TEST_CASE("neighbours are renewed in the outermost of the loops named") {
  const auto renewals_of = [](const std::vector<const char*>& named, bool side_by_side) {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("b", 2, {2, 2}, 1.0));
    const Physics physics(run);
    physics.loop("day", {"all"});
    physics.loop("hour", {"all"}, side_by_side ? nullptr : "day", side_by_side ? nullptr : "all");
    physics.loop("minute", {"all"}, "hour", "all");
    physics.attach("day", "all", limiter(1.0));
    physics.attach("hour", "all", limiter(0.25));
    physics.attach("minute", "all", limiter(0.05));
    for (const char* loop : named) physics.renew_neighbours_in(loop);
    run.finalise();
    run.initialise();
    const std::uint64_t before = run.timings().renewals;
    run.step();
    return run.timings().renewals - before;
  };
  CHECK(renewals_of({}, false) == 1);
  CHECK(renewals_of({"day"}, false) == 1);
  CHECK(renewals_of({"hour"}, false) == 4);
  CHECK(renewals_of({"minute", "hour"}, false) == 4);
  CHECK(renewals_of({"minute"}, false) == 20);
  CHECK(renewals_of({"day", "hour"}, true) == 1);
  CHECK(renewals_of({"hour", "minute"}, true) == 4);
}

TEST_CASE("an operator ends the run behind the outer step in which it has had enough") {
  static std::string said;
  SimulationSettings wanted = settings(2, 1.0);
  wanted.take_finish = [] { return std::exchange(said, {}); };
  said = "somebody else's";
  Simulation run(wanted);
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("steps", {"work"});
  physics.attach("steps", "work", limiter(0.1));
  Operator op;
  op.name = "test.enough";
  op.end = [](const shoal_step& step, const double*) {
    if (step.number == 2) said = "enough";
    return SHOAL_OK;
  };
  physics.attach("steps", "work", op);
  run.finalise();
  run.initialise();
  while (!run.finished()) run.step();
  CHECK(run.outer_steps() == 3);
  CHECK(run.finish_reason() == "enough");
  CHECK(run.end_time() == 1.0);
  // Gone on by somebody who wants more.
  run.set_finish_reason({});
  while (!run.finished()) run.step();
  CHECK(run.time() == 1.0);
  CHECK(run.finish_reason().empty());
}
