// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators: chunks, reductions, clearing, fields on demand, failures.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <vector>

#include "hand_made.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

struct Result {
  std::vector<double> values;
};

// Sum, minimum and maximum of numbers of very different size, on n particles.
std::vector<double> reduce(int n, int threads, std::uint32_t flags = 0) {
  SimulationSettings what = settings(2, 1.0);
  what.threads = threads;
  Simulation run(what);
  run.add_body(lattice("b", 2, {n, 1}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  std::vector<double> results;
  Operator op;
  op.flags = flags;
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.reductions = {SHOAL_SUM, SHOAL_MINIMUM, SHOAL_MAXIMUM};
  op.run = [](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      const double value = std::sin(views.real(0)[2 * i]) * std::pow(10.0, static_cast<double>(i % 17) - 8.0);
      chunk.partial[0] += value;
      chunk.partial[1] = std::min(chunk.partial[1], value);
      chunk.partial[2] = std::max(chunk.partial[2], value);
    }
    return SHOAL_OK;
  };
  op.end = [&](const shoal_step&, const double* values) {
    results.assign(values, values + 3);
    return SHOAL_OK;
  };
  physics.attach("main", "all", op);
  run.finalise();
  run.initialise();
  run.step();
  return results;
}

// Chunk sums combined pair by pair, written as a recursion.
double tree_sum(const std::vector<double>& values) {
  if (values.size() == 1) return values[0];
  std::vector<double> next;
  for (std::size_t k = 0; k < values.size(); k += 2)
    next.push_back(k + 1 < values.size() ? values[k] + values[k + 1] : values[k]);
  return tree_sum(next);
}

}  // namespace

TEST_CASE("reductions are bitwise equal for any number of threads, and follow the tree") {
  for (const int n : {1, 127, 128, 129, 4999, 20011, 100000}) {
    const std::vector<double> one = reduce(n, 1), two = reduce(n, 2), three = reduce(n, 3);
    CHECK(one == two);
    CHECK(one == three);
    std::vector<double> chunks;
    double smallest = 1e300, largest = -1e300;
    for (int i = 0; i < n; ++i) {
      if (i % 128 == 0) chunks.push_back(0.0);
      const double value = std::sin(i + 0.5) * std::pow(10.0, i % 17 - 8.0);
      chunks.back() += value;
      smallest = std::min(smallest, value);
      largest = std::max(largest, value);
    }
    CHECK(one[0] == tree_sum(chunks));
    CHECK(one[1] == smallest);
    CHECK(one[2] == largest);
  }
  CHECK(reduce(0, 2) == std::vector<double>{0.0, std::numeric_limits<double>::infinity(),
                                            -std::numeric_limits<double>::infinity()});
  CHECK(reduce(20000, 2, SHOAL_OPERATOR_SERIAL)[1] == reduce(20000, 2)[1]);
}

TEST_CASE("chunks are 128 particles, each once, in order where serial") {
  for (const int n : {600, 10000}) {
    for (const bool serial : {false, true}) {
      SimulationSettings what = settings(2, 1.0);
      what.threads = 2;
      Simulation run(what);
      run.add_body(lattice("b", 2, {n, 1}, 1.0));
      const Physics physics(run);
      physics.loop("main", {"all"});
      Operator op;
      op.flags = serial ? static_cast<std::uint32_t>(SHOAL_OPERATOR_SERIAL) : 0u;
      std::mutex mutex;
      std::set<std::pair<std::uint64_t, std::uint64_t>> chunks;
      op.run = [&](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
        const std::lock_guard lock(mutex);
        chunks.insert({chunk.begin, chunk.end});
        CHECK((serial || chunk.begin == chunk.number * 128u));
        CHECK(views.n_owned == static_cast<std::uint64_t>(n));
        return SHOAL_OK;
      };
      physics.attach("main", "all", op);
      run.finalise();
      run.initialise();
      run.step();
      CHECK(chunks.size() == (serial ? 1 : (n + 127) / 128));
      std::uint64_t next = 0;
      for (const auto& [begin, end] : chunks) {
        CHECK(begin == next);
        next = end;
      }
      CHECK(next == static_cast<std::uint64_t>(n));
    }
  }
}

TEST_CASE("accumulated fields are cleared where their owner says, and operators without a stage run there") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {3, 3}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"force", "move"});
  std::vector<double> seen;
  Operator add;
  add.access("acceleration", SHOAL_ACCUMULATE, SHOAL_RANK_VECTOR);
  add.run = [](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
    for (std::uint64_t i = 2 * chunk.begin; i < 2 * chunk.end; ++i) views.real(0)[i] += 1.5;
    return SHOAL_OK;
  };
  Operator use;
  use.access("acceleration", SHOAL_READ, SHOAL_RANK_VECTOR);
  use.run = [&](const Views& views, const shoal_step&, const shoal_chunk&) {
    seen.push_back(views.real(0)[17]);
    return SHOAL_OK;
  };
  physics.attach("main", "move", use);
  physics.attach("main", "force", limiter(0.25));
  physics.attach(nullptr, nullptr, add);
  physics.own_field(0, "acceleration", "main", "force");
  physics.attach(nullptr, nullptr, add);
  run.finalise();
  run.initialise();
  while (!run.finished()) run.step();
  CHECK(seen == std::vector<double>{3.0, 3.0, 3.0, 3.0});
  CHECK(run.plan().loops[0].stages[0].clears == std::vector<std::string>{"b.acceleration"});

  Simulation nobody(settings(2, 1.0));
  nobody.add_body(lattice("b", 2, {3, 3}, 1.0));
  Physics(nobody).loop("main", {"force"});
  Physics(nobody).attach("main", "force", add);
  CHECK_THROWS_WITH_AS(
      nobody.finalise(),
      "operator test.operator on body 'b' adds to field 'acceleration', which nobody owns and clears "
      "on that body",
      ModelError);
}

TEST_CASE("operators on demand run only for those who read what they write, transitively") {
  const auto names_of = [](const std::function<void(Simulation&, const Physics&)>& more) {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("b", 2, {3, 3}, 1.0));
    const Physics physics(run);
    physics.loop("main", {"all"});
    const auto op = [](const char* name, const char* reads, const char* writes, std::uint32_t flags) {
      Operator what;
      what.name = name;
      what.flags = flags;
      what.access(reads, SHOAL_READ).access(writes, SHOAL_WRITE);
      return what;
    };
    physics.attach("main", "all", op("test.always", "density", "pressure", 0));
    physics.attach(SHOAL_SAMPLE, nullptr, op("test.c", "b_field", "c_field", SHOAL_OPERATOR_ON_DEMAND));
    physics.attach("main", "all", op("test.b", "a_field", "b_field", SHOAL_OPERATOR_ON_DEMAND));
    physics.attach("main", "all", op("test.a", "pressure", "a_field", SHOAL_OPERATOR_ON_DEMAND));
    more(run, physics);
    run.finalise();
    std::vector<std::string> names;
    for (const OperatorTiming& line : run.timings().operators) names.push_back(line.name);
    CHECK(run.plan().unscheduled.size() + names.size() == 4);
    for (const char* field : {"a_field", "b_field", "c_field"}) {
      const bool exists = run.field(0, field).data != nullptr;
      CHECK(exists == run.field_info(0, field).has_value());
      bool written = false;
      for (const std::string& name : names) written = written || name == std::string("test.") + field[0];
      CHECK(exists == written);
    }
    return names;
  };
  using Names = std::vector<std::string>;
  CHECK(names_of([](Simulation&, const Physics&) {}) == Names{"test.always"});
  CHECK(names_of([](Simulation& run, const Physics&) { run.demand_field("b", "a_field"); }) ==
        Names{"test.always", "test.a"});
  CHECK(names_of([](Simulation& run, const Physics&) { run.demand_field("b", "c_field"); }) ==
        Names{"test.always", "test.c", "test.b", "test.a"});
}

TEST_CASE("optional fields exist only if somebody else wants them") {
  for (const bool wanted : {false, true}) {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("b", 2, {3, 3}, 1.0));
    const Physics physics(run);
    physics.loop("main", {"all"});
    Operator op;
    op.access("temperature", SHOAL_READ | SHOAL_OPTIONAL);
    const void* data = &run;
    op.bind = [&](const Views& views) {
      data = views.own[0].data;
      return SHOAL_OK;
    };
    physics.attach("main", "all", op);
    Operator writer;
    writer.access("temperature", SHOAL_WRITE);
    if (wanted) physics.attach("main", "all", writer);
    run.finalise();
    run.initialise();
    run.step();
    CHECK((data != nullptr) == wanted);
  }
}

TEST_CASE("demands and initial values of fields that do not exist are answered with those that do") {
  const auto finalise = [](const std::function<void(Simulation&)>& ask, InitialField initial = {}) {
    Simulation run(settings(2, 1.0));
    BodySpecification body = lattice("water", 2, {3, 3}, 1.0);
    if (!initial.name.empty()) body.initial_fields.push_back(std::move(initial));
    run.add_body(body);
    const Physics physics(run);
    physics.loop("main", {"all"});
    Operator op;
    op.name = "test.vorticity";
    op.flags = SHOAL_OPERATOR_ON_DEMAND;
    op.access("velocity", SHOAL_READ, SHOAL_RANK_VECTOR).access("vorticity", SHOAL_WRITE);
    physics.attach(SHOAL_SAMPLE, nullptr, op);
    physics.attach("main", "all", mover());
    try {
      ask(run);
      run.finalise();
    } catch (const ModelError& error) {
      return error.place() + ": " + error.what();
    }
    return std::string("no error");
  };
  CHECK(finalise([](Simulation& run) { run.demand_field("water", "vorticity", "a:1"); }) == "no error");
  CHECK(finalise([](Simulation& run) { run.demand_field("water", "vortisity", "a.yaml:7:3"); }) ==
        "a.yaml:7:3: body 'water' has no field 'vortisity'; its fields: 'position', 'velocity' and "
        "'vorticity'");
  CHECK(finalise([](Simulation& run) { run.demand_field("wall", "velocity", "a.yaml:7:3"); }) ==
        "a.yaml:7:3: there is no body 'wall'; bodies: 'water'");
  const auto nothing = [](std::uint64_t, const double*, double*) {};
  CHECK(finalise([](Simulation&) {}, {"velocty", SHOAL_RANK_VECTOR, nothing, "a.yaml:3:4"}) ==
        "a.yaml:3:4: body 'water' has no field 'velocty' that could be given a value; its fields: 'position' "
        "and "
        "'velocity'");
  CHECK(finalise([](Simulation&) {}, {"velocity", SHOAL_SCALAR, nothing, "a.yaml:3:4"}) ==
        "a.yaml:3:4: field 'velocity' of body 'water' is a real vector, but is given a real scalar");
}

TEST_CASE("initial values, volume and reference positions are there before stage initial") {
  Simulation run(settings(2, 1.0));
  BodySpecification body = lattice("b", 2, {3, 3}, 0.5);
  body.initial_fields.push_back({"velocity", SHOAL_RANK_VECTOR,
                                 [](std::uint64_t n, const double* x, double* out) {
                                   for (std::uint64_t k = 0; k < 2 * n; ++k) out[k] = 10.0 * x[k];
                                 },
                                 ""});
  run.add_body(body);
  const Physics physics(run);
  physics.loop("main", {"all"});
  Operator op;
  op.access("volume", SHOAL_READ).access("velocity", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.access("reference_position", SHOAL_READ, SHOAL_RANK_VECTOR).access("mass", SHOAL_WRITE);
  op.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
    CHECK(step.dt == 0.0);
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
      views.real(3)[i] = 1000.0 * views.real(0)[i] + views.real(1)[2 * i + 1] + views.real(2)[2 * i];
    return SHOAL_OK;
  };
  physics.attach(SHOAL_INITIAL, nullptr, op);
  run.finalise();
  run.initialise();
  const auto* mass = static_cast<const double*>(run.field(0, "mass").data);
  CHECK(mass[0] == 1000.0 * 0.25 + 2.5 + 0.25);
  CHECK(mass[5] == 1000.0 * 0.25 + 12.5 + 0.75);
}

TEST_CASE("writing what neighbours read is refused, unless the operator is serial") {
  for (const std::uint32_t flags : {0u, static_cast<std::uint32_t>(SHOAL_OPERATOR_SERIAL)}) {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("b", 2, {3, 3}, 1.0));
    const Physics physics(run);
    physics.loop("main", {"all"});
    Operator op;
    op.flags = flags;
    op.access("density", SHOAL_READ | SHOAL_OF_NEIGHBOURS).access("density", SHOAL_WRITE).relation(0, 2.0);
    physics.attach("main", "all", op);
    const std::string message = message_of([&] { run.finalise(); });
    if (flags == 0)
      CHECK(message ==
            "operator test.operator on body 'b' changes field 'density' while it reads it of neighbours in "
            "the same "
            "body; write to a field of its own and let another operator move the values");
    else
      CHECK(message == "no error");
  }
}

TEST_CASE("statuses become exceptions with the plugin's own words") {
  static thread_local std::string text;
  const auto run_one = [](shoal_status status, bool throws, int n) {
    SimulationSettings what = settings(2, 1.0);
    what.threads = 2;
    what.failures.take = [] { return std::exchange(text, {}); };
    Simulation run(what);
    run.add_body(lattice("b", 2, {n, 1}, 1.0));
    const Physics physics(run);
    physics.loop("main", {"all"});
    Operator op;
    op.run = [=](const Views&, const shoal_step&, const shoal_chunk& chunk) {
      if (throws) throw std::runtime_error("escaped");
      if (chunk.begin < 128) return SHOAL_OK;
      text = "the table ends at chunk " + std::to_string(chunk.number);
      return status;
    };
    physics.attach("main", "all", op);
    run.finalise();
    run.initialise();
    run.step();
  };
  const std::string start = "operator test.operator on body 'b' failed in run: ";
  CHECK_THROWS_WITH_AS(run_one(SHOAL_ERROR, false, 1000), (start + "the table ends at chunk 1").c_str(),
                       OperatorFailure);
  CHECK_THROWS_WITH_AS(run_one(SHOAL_CASE_ERROR, false, 1000), (start + "the table ends at chunk 1").c_str(),
                       ModelError);
  CHECK_THROWS_AS(run_one(SHOAL_PHYSICS_FAILED, false, 1000), PhysicsFailure);
  CHECK_THROWS_AS(run_one(SHOAL_ERROR, false, 100000), OperatorFailure);
  CHECK_THROWS_WITH_AS(run_one(SHOAL_OK, true, 1000),
                       (start + "an exception left the plugin, which its contract forbids: escaped").c_str(),
                       OperatorFailure);
}

TEST_CASE("timings count calls, particles and true pairs") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {20, 20}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.125));
  Operator op;
  std::atomic<std::uint64_t> pairs = 0;
  op.name = "test.pairs";
  op.access("position", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR).relation(0, 2.6);
  op.bytes_per_pair = 16;
  op.bytes_per_particle = 24;
  op.run = [&](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) pairs += views.neighbours[0].counts[i];
    return SHOAL_OK;
  };
  physics.attach("main", "all", op);
  run.finalise();
  run.initialise();
  while (!run.finished()) run.step();
  const Timings timings = run.timings();
  const OperatorTiming& line = timings.operators[1];
  CHECK(line.calls == 8);
  CHECK(line.particles == 8 * 400);
  CHECK(line.pairs == pairs);
  CHECK(line.seconds > 0.0);
  CHECK(timings.loops[0].limited_by == "test.limit");
  CHECK(timings.list_builds == 1);  // nothing has moved
  const Plan plan = run.plan();
  CHECK(plan.relations[0].mean_neighbours == doctest::Approx(static_cast<double>(pairs) / 8 / 400));
  CHECK(plan.relations[0].kept_bytes_per_pair == 16);
  CHECK(plan.bodies[0].list_bytes > 16 * pairs / 8);  // with what the operator keeps beside the list
  CHECK(plan.bodies[0].kept_bytes_per_particle == 24);
  CHECK(plan.total_bytes == plan.bodies[0].field_bytes + plan.bodies[0].list_bytes + 24 * 400);
}

TEST_CASE("all chunks are prepared before the first of them runs, on any number of threads") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {120, 120}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.125));
  Operator op;
  std::atomic<std::uint64_t> prepared = 0, run_early = 0, called = 0;
  op.name = "test.prepares";
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.prepare = [&](const Views&, const shoal_step&, const shoal_chunk& chunk) {
    prepared += chunk.end - chunk.begin;
    return SHOAL_OK;
  };
  op.run = [&](const Views& views, const shoal_step&, const shoal_chunk&) {
    ++called;
    if (prepared % views.n_owned != 0) ++run_early;
    return SHOAL_OK;
  };
  physics.attach("main", "all", op);
  run.finalise();
  run.initialise();
  while (!run.finished()) run.step();
  CHECK(prepared == 8 * 14400);
  CHECK(called == 8 * ((14400 + 127) / 128));
  CHECK(run_early == 0);
}

TEST_CASE("a field counts its changes, and rests while nobody writes it") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {20, 20}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"write", "read"});
  physics.attach("main", "write", limiter(0.125));
  Operator writer, reader;
  writer.name = "test.writer";
  writer.access("pressure", SHOAL_WRITE);
  writer.run = [&](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) views.real(0)[i] = step.time;
    return SHOAL_OK;
  };
  physics.attach("main", "write", writer);
  std::vector<std::uint64_t> of_position, of_pressure;
  reader.name = "test.reader";
  reader.access("position", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
      .access("pressure", SHOAL_READ | SHOAL_OF_NEIGHBOURS)
      .relation(0, 2.6);
  reader.run = [&](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
    if (chunk.number == 0) {
      of_position.push_back(*views.of_neighbours[0].changes);
      of_pressure.push_back(*views.of_neighbours[1].changes);
    }
    return SHOAL_OK;
  };
  physics.attach("main", "read", reader);
  run.finalise();
  run.initialise();
  while (!run.finished()) run.step();
  REQUIRE(of_position.size() == 8);
  for (std::size_t k = 1; k < 8; ++k) {
    CHECK(of_position[k] == of_position[k - 1]);
    CHECK(of_pressure[k] > of_pressure[k - 1]);
  }
}

TEST_CASE("an operator that cannot prepare says so") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {10, 10}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  physics.attach("main", "all", limiter(0.125));
  Operator op;
  op.name = "test.prepares";
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
  op.prepare = [&](const Views&, const shoal_step&, const shoal_chunk&) { return SHOAL_ERROR; };
  op.run = [&](const Views&, const shoal_step&, const shoal_chunk&) { return SHOAL_OK; };
  physics.attach("main", "all", op);
  run.finalise();
  run.initialise();
  CHECK_THROWS_AS(run.step(), OperatorFailure);
}
