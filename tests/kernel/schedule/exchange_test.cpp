// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Particles that leave and join during a run: against a list of particles kept by hand, over restarts, on any number of
// threads.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "hand_made.hpp"
#include "kernel/particles/body.hpp"
#include "kernel/schedule/simulation.hpp"

using namespace shoal::kernel;
using namespace hand_made;

namespace {

// A stream of soft particles to the right through a box that is periodic across: behind its end they leave, and each that
// passes x = 0.5 leaves a copy of itself at the inlet, half a length behind; every third step one comes from nowhere.
struct Stream {
  Simulation run;

  explicit Stream(int threads = 1, int columns = 20) : run(make(threads, 0.1 * columns)) {
    BodySpecification water = lattice("water", 2, {columns, 10}, 0.1);
    water.initial_fields.push_back(values("velocity", SHOAL_RANK_VECTOR, 2, 1.0));
    water.initial_fields.push_back(values("colour", SHOAL_SCALAR, 1, 7.0));
    run.add_body(water);
    const Physics physics(run);
    physics.loop("outer", {"inner"});
    physics.loop("inner", {"force", "move"}, "outer", "inner");
    physics.renew_neighbours_in("outer");
    physics.body_moves(0);
    physics.own_field(0, "acceleration", "inner", "force");
    physics.attach("outer", "inner", limiter(0.04));
    physics.attach("inner", "force", limiter(0.015));
    physics.attach("inner", "force", force());
    physics.attach("inner", "move", mover(0));
    physics.attach("inner", "move", boundary(0.1 * columns));
    run.finalise();
  }

  static SimulationSettings make(int threads, double length) {
    SimulationSettings what = settings(2, 10.0);
    what.threads = threads;
    what.sort_interval = 3;
    what.lower[0] = -1.0;
    what.upper[0] = length + 2.0;
    what.lower[1] = 0.0;
    what.upper[1] = 1.0;
    what.boundaries[1] = {BoundaryKind::periodic, BoundaryKind::periodic};
    return what;
  }

  static InitialField values(const char* name, shoal_rank rank, std::uint64_t components, double first) {
    return {name, rank,
            [=](std::uint64_t n, const double* x, double* out) {
              for (std::uint64_t k = 0; k < n; ++k)
                for (std::uint64_t c = 0; c < components; ++c)
                  out[components * k + c] = c == 0 ? first + 0.1 * x[2 * k] : 0.05 * std::sin(9.0 * x[2 * k]);
            },
            ""};
  }

  // Reads its neighbours at the present positions, so that a list or an image of before would show.
  static Operator force() {
    Operator op;
    op.name = "stream.force";
    op.access("position", SHOAL_READ | SHOAL_OF_NEIGHBOURS, SHOAL_RANK_VECTOR)
        .access("acceleration", SHOAL_ACCUMULATE | SHOAL_DERIVED, SHOAL_RANK_VECTOR)
        .access("velocity", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_VECTOR)
        .access("colour", SHOAL_READ)
        .relation(0, 0.26);
    op.run = [](const Views& views, const shoal_step& step, const shoal_chunk& chunk) {
      const shoal_neighbours& list = views.neighbours[0];
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
        for (std::uint32_t k = 0; k < list.counts[i]; ++k) {
          const std::uint64_t j = list.indices[list.offsets[i] + k];
          const double x = views.real(0)[2 * i] - views.neighbour_real(0, 0)[2 * j];
          const double y = views.real(0)[2 * i + 1] - views.neighbour_real(0, 0)[2 * j + 1];
          const double r = std::sqrt(x * x + y * y);
          if (r >= 0.26 || r < 1e-9) continue;
          views.real(1)[2 * i + 1] += 5.0 * (0.26 - r) * y / r;
        }
        views.real(2)[2 * i + 1] += step.dt * views.real(1)[2 * i + 1];
      }
      return SHOAL_OK;
    };
    return op;
  }

  static Operator boundary(double length) {
    auto leaving = std::make_shared<std::vector<std::uint64_t>>();
    auto sources = std::make_shared<std::vector<std::uint64_t>>();
    Operator op;
    op.name = "stream.boundary";
    op.access("position", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_VECTOR)
        .access("velocity", SHOAL_READ | SHOAL_WRITE, SHOAL_RANK_VECTOR)
        .access("passed", SHOAL_READ | SHOAL_WRITE, SHOAL_SCALAR, SHOAL_INT64);
    op.exchange = [=](const Views& views, const shoal_step& step, shoal_exchange& asked) {
      leaving->clear();
      sources->clear();
      for (std::uint64_t i = 0; i < views.n_owned; ++i) {
        const double x = views.real(0)[2 * i];
        if (x > length) leaving->push_back(i);
        if (x > 0.5 && x < 0.7 && views.integer(2)[i] == 0) {
          views.integer(2)[i] = 1;
          sources->push_back(i);
        }
      }
      if (step.number % 3 == 2) sources->push_back(UINT64_MAX);
      asked.n_leaving = leaving->size();
      asked.leaving = leaving->data();
      asked.n_joining = sources->size();
      asked.sources = sources->data();
      return SHOAL_OK;
    };
    op.fill = [=](const Views& views, const shoal_step&, std::uint64_t begin, std::uint64_t end) {
      for (std::uint64_t i = begin; i < end; ++i) {
        const bool is_copy = (*sources)[i - begin] != UINT64_MAX;
        views.integer(2)[i] = is_copy ? 0 : 2;
        if (is_copy) {
          views.real(0)[2 * i] -= 0.5;
        } else {
          views.real(0)[2 * i] = 0.2;
          views.real(0)[2 * i + 1] = 0.5;
          views.real(1)[2 * i] = 2.0;
        }
      }
      return SHOAL_OK;
    };
    return op;
  }
};

struct State {
  std::vector<std::int64_t> ids;
  std::vector<double> positions, velocities, colours;
  bool operator==(const State&) const = default;
};

State state_of(const Simulation& run) {
  State state;
  const std::uint64_t n = run.n_particles(0);
  const auto copy = [&](const char* name, std::uint64_t components) {
    const auto* data = static_cast<const double*>(run.field(0, name).data);
    return std::vector<double>(data, data + n * components);
  };
  state.ids.assign(run.ids(0), run.ids(0) + n);
  state.positions = copy("position", 2);
  state.velocities = copy("velocity", 2);
  state.colours = copy("colour", 1);
  return state;
}

}  // namespace

TEST_CASE("particles of a body leave and join: against a list kept by hand") {
  std::mt19937 random(3);
  Body body("water", 0, 2);
  FieldSpecification specification{"tag", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, "1", "", 0};
  body.declare(specification, "test");
  struct Known {
    std::int64_t id;
    double x, y, tag_x, tag_y;
  };
  std::vector<Known> known;
  body.resize(50);
  const auto check = [&] {
    REQUIRE(body.n_owned() == known.size());
    for (std::uint64_t i = 0; i < body.n_owned(); ++i) {
      const auto found = std::find_if(known.begin(), known.end(),
                                      [&](const Known& one) { return one.id == body.ids().integers()[i]; });
      REQUIRE(found != known.end());
      CHECK(body.position().reals()[2 * i] == found->x);
      CHECK(body.position().reals()[2 * i + 1] == found->y);
      CHECK(body.find("tag")->reals()[2 * i] == found->tag_x);
      CHECK(body.find("tag")->reals()[2 * i + 1] == found->tag_y);
    }
  };
  for (std::uint64_t i = 0; i < 50; ++i) {
    const double v = static_cast<double>(i);
    known.push_back({static_cast<std::int64_t>(i), v, 0.5 * v, -v, 3.0 * v});
    body.position().reals()[2 * i] = v;
    body.position().reals()[2 * i + 1] = 0.5 * v;
    body.find("tag")->reals()[2 * i] = -v;
    body.find("tag")->reals()[2 * i + 1] = 3.0 * v;
  }
  std::int64_t next_id = 50;
  for (int round = 0; round < 60; ++round) {
    const std::uint64_t n = body.n_owned();
    std::vector<std::uint64_t> leaving, sources;
    const int kind = round % 4;  // some, none, all at the end, everyone
    for (std::uint64_t i = 0; i < n; ++i)
      if ((kind == 0 && random() % 3 == 0) || (kind == 2 && i + 5 >= n) || (kind == 3 && round % 8 == 7))
        leaving.push_back(i);
    for (std::uint64_t k = random() % 30; k > 0; --k)
      sources.push_back(n == 0 || random() % 4 == 0 ? Body::no_source : random() % n);
    std::vector<Known> joined;
    for (const std::uint64_t source : sources) {
      Known one{next_id++, 0, 0, 0, 0};
      if (source != Body::no_source) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const Known& candidate) {
          return candidate.id == body.ids().integers()[source];
        });
        one = {one.id, found->x, found->y, found->tag_x, found->tag_y};
      }
      joined.push_back(one);
    }
    for (const std::uint64_t i : leaving)
      known.erase(std::find_if(known.begin(), known.end(),
                               [&](const Known& one) { return one.id == body.ids().integers()[i]; }));
    body.exchange(leaving, sources);
    known.insert(known.end(), joined.begin(), joined.end());
    check();
    for (std::size_t k = 0; k < joined.size(); ++k)
      CHECK(body.ids().integers()[body.n_owned() - joined.size() + k] == joined[k].id);
  }
}

TEST_CASE("a stream keeps its number of particles, and those that join have what they should") {
  Stream stream;
  stream.run.initialise();
  const std::uint64_t n = stream.run.n_particles(0);
  std::int64_t largest = -1;
  std::uint64_t from_nowhere = 0;
  for (int k = 0; k < 90; ++k) {
    stream.run.step();
    const State state = state_of(stream.run);
    for (std::size_t i = 0; i < state.ids.size(); ++i) {
      if (state.ids[i] <= largest || k == 0) continue;
      // Copies keep the colour of their kind, others have that of the place where they came in.
      const double colour = state.colours[i];
      if (std::abs(colour - 7.02) < 1e-12) ++from_nowhere;
      CHECK(colour >= 7.0);
    }
    largest = std::max(largest, *std::max_element(state.ids.begin(), state.ids.end()));
    std::vector<std::int64_t> ids = state.ids;
    std::sort(ids.begin(), ids.end());
    CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
    for (std::size_t i = 0; i < state.ids.size(); ++i) CHECK(state.positions[2 * i] < 2.0 + 0.2);
  }
  CHECK(from_nowhere == 30);
  CHECK(stream.run.n_particles(0) > n / 2);
  CHECK(stream.run.n_particles(0) < 2 * n);
  CHECK(largest > static_cast<std::int64_t>(n + 200));
}

TEST_CASE("particles that leave and join: bitwise the same on any number of threads") {
  // Enough particles that work is spread over threads
  Stream one(1, 600), three(3, 600);
  for (Stream* stream : {&one, &three}) {
    stream->run.initialise();
    for (int k = 0; k < 12; ++k) stream->run.step();
  }
  CHECK(state_of(one.run) == state_of(three.run));
}

TEST_CASE("particles that leave and join: stopped and resumed is bitwise the same") {
  Stream whole;
  whole.run.initialise();
  for (int k = 0; k < 40; ++k) whole.run.step();
  for (const int stop : {1, 17, 38}) {
    Stream first;
    first.run.initialise();
    for (int k = 0; k < stop; ++k) first.run.step();
    std::stringstream checkpoint;
    first.run.save(checkpoint);
    Stream second;
    second.run.load(checkpoint);
    CHECK(second.run.n_particles(0) == first.run.n_particles(0));
    for (int k = stop; k < 40; ++k) second.run.step();
    CHECK(state_of(whole.run) == state_of(second.run));
  }
}

TEST_CASE("what an exchange must not ask for") {
  const auto run_with = [](std::vector<std::uint64_t> leaving, std::vector<std::uint64_t> sources) {
    Simulation run(settings(2, 1.0));
    run.add_body(lattice("water", 2, {4, 4}, 0.1));
    const Physics physics(run);
    physics.loop("flow", {"move"});
    physics.attach("flow", "move", limiter(0.1));
    Operator op;
    op.name = "test.exchange";
    op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR);
    op.exchange = [=](const Views&, const shoal_step&, shoal_exchange& asked) {
      asked.n_leaving = leaving.size();
      asked.leaving = leaving.data();
      asked.n_joining = sources.size();
      asked.sources = sources.data();
      return SHOAL_OK;
    };
    physics.attach("flow", "move", op);
    run.finalise();
    run.initialise();
    return message_of([&] { run.step(); });
  };
  const std::string begin = "operator test.exchange on body 'water' failed in exchange: ";
  CHECK(run_with({3, 16}, {}) == begin + "particle 16 is to leave, of 16");
  CHECK(run_with({5, 5}, {}) == begin + "the particles that leave are not in ascending order");
  CHECK(run_with({}, {16}) == begin + "particle 16 is to be copied, of 16");
  CHECK(run_with({0, 15}, {0, 15}) == "no error");
  CHECK(run_with({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {}) == "no error");
}

TEST_CASE("no exchange where neighbours are found once for the whole run") {
  Simulation run(settings(2, 1.0));
  run.add_body(lattice("block", 2, {4, 4}, 0.1));
  const Physics physics(run);
  physics.loop("flow", {"move"});
  Operator op;
  op.name = "test.exchange";
  op.access("position", SHOAL_READ, SHOAL_RANK_VECTOR).relation(0, 0.26, SHOAL_REFERENCE);
  op.exchange = [](const Views&, const shoal_step&, shoal_exchange&) { return SHOAL_OK; };
  physics.attach("flow", "move", op);
  CHECK(
      message_of([&] { run.finalise(); }) ==
      "operator test.exchange on body 'block' lets particles join or leave, but neighbours of that body are "
      "found once for the whole run, in the reference configuration; it cannot have both");
}
