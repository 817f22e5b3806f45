// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A run that was stopped and resumed is the run that went on, bit by bit; a damaged checkpoint is refused whole.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "hand_made.hpp"
#include "kernel/schedule/block_file.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

// A gas of soft particles in a periodic box with sub-cycles, re-sorting, a reference list, an integer field, a derived
// field and an operator with a memory of its own: everything that a checkpoint must carry.
struct Gas {
  Simulation run;
  std::uint64_t memory = 0;

  explicit Gas(int threads = 1, const char* extra_field = nullptr, const char* body = "gas")
      : run(make(threads)) {
    BodySpecification gas = lattice(body, 2, {30, 30}, 0.1);
    gas.initial_fields.push_back({"velocity", SHOAL_RANK_VECTOR,
                                  [](std::uint64_t n, const double* x, double* v) {
                                    for (std::uint64_t k = 0; k < n; ++k) {
                                      v[2 * k] = std::sin(7.0 * x[2 * k + 1]);
                                      v[2 * k + 1] = std::cos(5.0 * x[2 * k]);
                                    }
                                  },
                                  ""});
    run.add_body(gas);
    run.add_body(lattice("still", 2, {5, 5}, 0.1, {0.5, 0.5, 0.0}));
    const Physics physics(run);
    physics.loop("outer", {"start", "inner", "end"});
    physics.loop("inner", {"force", "move"}, "outer", "inner");
    physics.renew_neighbours_in("outer");
    physics.body_moves(0);
    physics.own_field(0, "acceleration", "inner", "force");
    physics.attach("outer", "start", speed_limit(0.02));
    physics.attach("inner", "force", speed_limit(0.006));
    physics.attach("inner", "force", force(0, "position", SHOAL_CURRENT));
    physics.attach("inner", "force", force(1, "position", SHOAL_CURRENT));
    physics.attach("inner", "move", kick());
    physics.attach("inner", "move", mover(0));
    physics.attach("outer", "end", count());
    physics.attach("outer", "end", still());
    if (extra_field != nullptr) {
      Operator op;
      op.access(extra_field, SHOAL_WRITE);
      physics.attach("outer", "end", op);
    }
    run.finalise();
  }

  static SimulationSettings make(int threads) {
    SimulationSettings what = settings(2, 10.0);
    what.threads = threads;
    what.sort_interval = 3;
    for (int a = 0; a < 2; ++a) {
      what.lower[a] = 0.0;
      what.upper[a] = 3.0;
      what.boundaries[a] = {BoundaryKind::periodic, BoundaryKind::periodic};
    }
    return what;
  }

  static Operator speed_limit(double length) {
    Operator op;
    op.name = "gas.speed";
    op.flags = SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES;
    op.access("velocity", SHOAL_READ, SHOAL_RANK_VECTOR);
    op.time_step = [length](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
      double fastest = 1e-3;
      for (std::uint64_t k = 2 * chunk.begin; k < 2 * chunk.end; ++k)
        fastest = std::max(fastest, std::abs(views.real(0)[k]));
      return length / fastest;
    };
    return op;
  }

  static Operator force(std::uint32_t neighbours, const char* position, shoal_configuration configuration) {
    Operator op;
    op.name = "gas.force";
    op.access(position, SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
        .access("acceleration", SHOAL_ACCUMULATE | SHOAL_DERIVED, SHOAL_RANK_VECTOR)
        .relation(neighbours, 0.26, configuration);
    op.run = [](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
      const shoal_neighbours& list = views.neighbours[0];
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        for (std::uint32_t k = 0; k < list.counts[i]; ++k) {
          const std::uint64_t j = list.indices[list.offsets[i] + k];
          const double x = views.real(0)[2 * i] - views.neighbour_real(0, 0)[2 * j];
          const double y = views.real(0)[2 * i + 1] - views.neighbour_real(0, 0)[2 * j + 1];
          const double r = std::sqrt(x * x + y * y);
          if (r >= 0.26 || r < 1e-9) continue;
          views.real(1)[2 * i] += 20.0 * (0.26 - r) * x / r;
          views.real(1)[2 * i + 1] += 20.0 * (0.26 - r) * y / r;
        }
      return SHOAL_OK;
    };
    return op;
  }

  static Operator kick() {
    Operator op;
    op.name = "gas.kick";
    op.access("velocity", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_VECTOR)
        .access("acceleration", SHOAL_READ, SHOAL_RANK_VECTOR);
    op.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
      for (std::uint64_t k = 2 * chunk.begin; k < 2 * chunk.end; ++k)
        views.real(0)[k] += step.dt * views.real(1)[k];
      return SHOAL_OK;
    };
    return op;
  }

  // Counts steps in a field of integers, and in a number of its own that it adds to all of them.
  Operator count() {
    Operator op;
    op.name = "gas.count";
    op.access("counter", SHOAL_READ | SHOAL_WRITE, SHOAL_SCALAR, SHOAL_INT64);
    op.begin = [this](const shoal_step&) {
      memory = memory * 3 + 1;
      return SHOAL_OK;
    };
    op.run = [this](const Views& views, const shoal_step&, const shoal_chunk& chunk) {
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        views.integer(0)[i] += static_cast<std::int64_t>(memory % 1000);
      return SHOAL_OK;
    };
    op.save = [this](const shoal_stream& stream) {
      return stream.write(stream.context, &memory, sizeof memory);
    };
    op.load = [this](const shoal_stream& stream) {
      return stream.read(stream.context, &memory, sizeof memory);
    };
    return op;
  }

  // A body that rests, with neighbours in the reference configuration.
  static Operator still() {
    Operator op;
    op.name = "still.sum";
    op.body = 1;
    op.access("reference_position", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
        .access("sum", SHOAL_READ | SHOAL_WRITE)
        .relation(1, 0.15, SHOAL_REFERENCE);
    op.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        views.real(1)[i] += step.dt * views.neighbours[0].counts[i];
      return SHOAL_OK;
    };
    return op;
  }

  std::string bytes(std::uint32_t body, const char* field) const {
    const shoal_field view = run.field(body, field);
    return {static_cast<const char*>(view.data), view.n_owned * view.components * 8};
  }
  std::string everything() const {
    std::string all;
    for (const char* field : {"position", "velocity", "counter"}) all += bytes(0, field);
    all += bytes(1, "sum");
    all.append(reinterpret_cast<const char*>(run.ids(0)), run.n_particles(0) * 8);
    const double times[] = {run.time(), run.last_outer_dt(), run.last_dt("inner")};
    all.append(reinterpret_cast<const char*>(times), sizeof times);
    return all + std::to_string(run.loop_steps("inner")) + " " + std::to_string(run.outer_steps()) + " " +
           std::to_string(memory);
  }
  void steps(int n) {
    for (int k = 0; k < n; ++k) run.step();
  }
  std::string saved() {
    std::ostringstream stream;
    run.save(stream);
    return stream.str();
  }
};

std::string load(Gas& gas, const std::string& bytes) {
  return message_of([&] {
    std::istringstream stream(bytes);
    gas.run.load(stream);
  });
}

}  // namespace

TEST_CASE("2N steps equal N steps, a checkpoint, and N steps, bit by bit") {
  for (const int n : {1, 4, 9}) {
    Gas straight;
    straight.run.initialise();
    straight.steps(2 * n);

    std::string bytes;
    {
      Gas first(2);
      first.run.initialise();
      first.steps(n);
      bytes = first.saved();
      // Saving changes nothing.
      first.steps(n);
      CHECK(first.everything() == straight.everything());
    }
    Gas second;
    REQUIRE(load(second, bytes) == "no error");
    CHECK(second.run.outer_steps() == static_cast<std::uint64_t>(n));
    CHECK(second.saved() == bytes);
    second.steps(n);
    CHECK(second.everything() == straight.everything());
    CHECK(second.saved() == straight.saved());
  }
}

TEST_CASE("derived fields are not in a checkpoint, and are not missed") {
  Gas gas;
  const Plan plan = gas.run.plan();
  for (const PlanField& field : plan.bodies[0].fields) CHECK(field.derived == (field.name == "acceleration"));
  gas.run.initialise();
  CHECK(gas.saved().find("velocity") != std::string::npos);
  CHECK(gas.saved().find("acceleration") == std::string::npos);
}

TEST_CASE("every truncation and every flipped bit is found, and leaves the run as it was") {
  Gas source;
  source.run.initialise();
  source.steps(3);
  const std::string bytes = source.saved();
  Gas target;
  const std::string before = target.bytes(0, "position") + target.bytes(0, "velocity");
  int tried = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 7) {
    const std::string message = load(target, bytes.substr(0, length));
    CHECK((message.find("truncated") != std::string::npos || message.find("too short") != std::string::npos));
    ++tried;
  }
  for (std::size_t place = 0; place < bytes.size(); place += place < 400 ? 1 : 997) {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ (1 << (place % 8)));
    CHECK(load(target, damaged) != "no error");
    ++tried;
  }
  CHECK(tried > 400);
  CHECK(load(target, bytes + "x") == "the checkpoint is damaged: there is something behind its end");
  CHECK(load(target, "<?xml version=\"1.0\"?><VTKFile/>") ==
        "this is no checkpoint of Shoal: it does not begin with 'SHOALCKP'");
  std::string newer = bytes;
  newer[8] = 9;
  CHECK(load(target, newer) == "the checkpoint has format version 9; this Shoal reads 1");
  CHECK(target.bytes(0, "position") + target.bytes(0, "velocity") == before);
  CHECK(target.run.time() == 0.0);
  // And after all this the target still works.
  REQUIRE(load(target, bytes) == "no error");
  target.steps(2);
  source.steps(2);
  CHECK(target.everything() == source.everything());
}

TEST_CASE("a checkpoint of another case is refused") {
  Gas source;
  source.run.initialise();
  const std::string bytes = source.saved();
  Gas more(1, "temperature");
  CHECK(
      load(more, bytes) ==
      "the checkpoint belongs to another case: body 'gas' needs field 'temperature', which it does not hold");
  Gas other(1, nullptr, "plasma");
  CHECK(load(other, bytes) ==
        "the checkpoint belongs to another case: its bodies are 'gas' and 'still', not 'plasma' and 'still'");
  // More than is needed does no harm: an output may have been taken out of the case.
  more.run.initialise();
  Gas fewer;
  CHECK(load(fewer, more.saved()) == "no error");
}

TEST_CASE("an operator that leaves a part of its state unread is named") {
  Gas source;
  source.run.initialise();
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics physics(run);
  physics.loop("main", {"all"});
  Operator op;
  op.name = "test.state";
  std::uint64_t two[2] = {1, 2};
  op.save = [&](const shoal_stream& stream) { return stream.write(stream.context, two, 16); };
  op.load = [&](const shoal_stream& stream) { return stream.read(stream.context, two, 8); };
  physics.attach("main", "all", op);
  run.finalise();
  run.initialise();
  std::stringstream stream;
  run.save(stream);

  Simulation again(settings(2, 1.0));
  again.add_body(lattice("b", 2, {2, 2}, 1.0));
  const Physics second(again);
  second.loop("main", {"all"});
  second.attach("main", "all", op);
  again.finalise();
  CHECK(message_of([&] { again.load(stream); }) ==
        "operator test.state on b in main.all left 8 bytes of its state unread; was it saved by another "
        "version of its "
        "plugin?");
}

TEST_CASE("a disk that is full is an error") {
  struct Full : std::streambuf {
    int overflow(int) override { return traits_type::eof(); }
    std::streamsize xsputn(const char*, std::streamsize) override { return 0; }
  };
  Gas gas;
  gas.run.initialise();
  Full buffer;
  std::ostream stream(&buffer);
  CHECK_THROWS_WITH_AS(gas.run.save(stream), "the checkpoint could not be written (disk full?)",
                       CheckpointError);
}

TEST_CASE("the checksum does not depend on pieces, and sees every byte") {
  std::vector<unsigned char> bytes(1003);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<unsigned char>(k * 37);
  Checksum whole;
  whole.add(bytes.data(), bytes.size());
  for (const std::size_t piece : {1u, 3u, 8u, 100u}) {
    Checksum pieces;
    for (std::size_t k = 0; k < bytes.size(); k += piece)
      pieces.add(bytes.data() + k, std::min(piece, bytes.size() - k));
    CHECK(pieces.value() == whole.value());
  }
  int unseen = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (int bit = 0; bit < 8; ++bit) {
      bytes[k] = static_cast<unsigned char>(bytes[k] ^ (1 << bit));
      Checksum other;
      other.add(bytes.data(), bytes.size());
      unseen += other.value() == whole.value() ? 1 : 0;
      bytes[k] = static_cast<unsigned char>(bytes[k] ^ (1 << bit));
    }
  CHECK(unseen == 0);
  // Zeros at the end count too.
  Checksum a, b;
  const char zeros[16] = {};
  a.add(zeros, 8);
  b.add(zeros, 9);
  CHECK(a.value() != b.value());
}
