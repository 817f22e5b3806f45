// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plugin made with the SDK against a kernel of a later minor, whose structs are all longer than the plugin knows
// them; and exceptions in its operators. The kernel here is this file, so that its structs can be any length.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "kernel/plugins/host.hpp"
#include "kernel/plugins/registry.hpp"

using namespace shoal::kernel;

namespace {

// A struct as a later version might have it, and an array of such.
template <class Struct>
struct Longer {
  Struct today{};
  std::array<std::uint64_t, 3> later{0xdeadbeef, 0xdeadbeef, 0xdeadbeef};
  Longer() { today.size = sizeof(Longer); }
  explicit Longer(const Struct& from) : today(from) { today.size = sizeof(Longer); }
};
template <class Struct>
const Struct* first(const std::vector<Longer<Struct>>& array) {
  return array.empty() ? nullptr : &array.front().today;
}

const RegisteredType& type_of(const char* name) {
  static Loader loader([] {
    SearchSettings settings;
    settings.command_line = {SHOAL_TEST_PLUGINS};
    return settings;
  }());
  static Registry registry;
  if (registry.types().empty()) registry.add(loader.load("sdk_made"));
  const RegisteredType* type = registry.find(SHOAL_TYPE_OPERATOR, name);
  REQUIRE(type);
  return *type;
}

std::vector<shoal_operator> attached;
shoal_status attach(shoal_context*, const char*, const char*, const shoal_operator* op) {
  attached.push_back(*op);
  return SHOAL_OK;
}

// The operator that a type attaches for body 1 of two, with neighbours in the first `n_neighbours` of them. `last` is the value of its own
// parameter, which stands behind `bodies`, `neighbours` and `at`.
shoal_operator build(const RegisteredType& type, std::uint32_t n_neighbours, const shoal_value& last) {
  std::vector<Longer<shoal_body>> bodies(2);
  for (std::uint32_t k = 0; k < 2; ++k) {
    bodies[k].today.index = k;
    bodies[k].today.name = k == 0 ? "sand" : "water";
    bodies[k].today.spacing = 0.1;
    bodies[k].today.smoothing_length = 0.1 + k;
    bodies[k].today.cutoff = 0.2 + 2 * k;
    bodies[k].today.smoothing_kernel = "wendland_c2";
  }
  const std::int64_t here[] = {1}, both[] = {0, 1};
  REQUIRE(type.parameters.size() == 4);
  std::vector<Longer<shoal_value>> values(4);
  values[0].today.n = 1;
  values[0].today.integers = here;
  values[1].today.n = n_neighbours;
  values[1].today.integers = both;
  values[3] = Longer<shoal_value>(last);
  Longer<shoal_object> object;
  object.today.n_values = 4;
  object.today.type = type.original;
  object.today.values = first(values);
  Longer<shoal_builder> builder;
  builder.today.dimensions = 2;
  builder.today.n_bodies = 2;
  builder.today.bodies = first(bodies);
  builder.today.attach = attach;
  attached.clear();
  call_plugin("sdk_made", type.name, [&] {
    return static_cast<const shoal_physics_api*>(type.table.api)->build(&object.today, &builder.today);
  });
  REQUIRE(attached.size() == 1);
  return attached[0];
}

PluginFailure failure_of_run(const char* how) {
  shoal_value value{};
  value.n = 1;
  value.texts = &how;
  const shoal_operator op = build(type_of("sdk_made.throws"), 0, value);
  double total[3] = {};
  std::vector<Longer<shoal_field>> own;
  for (std::uint32_t a = 0; a < op.n_accesses; ++a) {
    own.emplace_back();
    own.back().today.components = 1;
    own.back().today.data = total;
    own.back().today.n_owned = own.back().today.n_total = 3;
  }
  Longer<shoal_binding> binding;
  binding.today.dimensions = 2;
  binding.today.n_owned = 3;
  binding.today.own = first(own);
  Longer<shoal_step> step;
  Longer<shoal_chunk> chunk;
  chunk.today.end = 3;
  call_plugin("sdk_made", op.name, [&] { return op.bind(op.self, &binding.today); });
  if (op.begin) call_plugin("sdk_made", op.name, [&] { return op.begin(op.self, &step.today); });
  try {
    call_plugin("sdk_made", op.name, [&] { return op.run(op.self, &step.today, &chunk.today); });
  } catch (const PluginFailure& failure) {
    op.destroy(op.self);
    return failure;
  }
  FAIL("run did not fail");
  throw;
}

}  // namespace

TEST_CASE("an operator that throws in run fails with its words and the right blame") {
  const PluginFailure error = failure_of_run("error");
  CHECK(error.status() == SHOAL_ERROR);
  CHECK(std::string(error.what()) == "sdk_made.throws: no memory for a thought");
  CHECK(error.plugin() == "sdk_made");
  const PluginFailure of_case = failure_of_run("case");
  CHECK(of_case.status() == SHOAL_CASE_ERROR);
  CHECK(of_case.text() == "the case asks too much");
  const PluginFailure physics = failure_of_run("physics");
  CHECK(physics.status() == SHOAL_PHYSICS_FAILED);
  CHECK(physics.text() == "the particle is gone");
  const PluginFailure number = failure_of_run("number");
  CHECK(number.status() == SHOAL_ERROR);
  CHECK(number.text() == "an exception of unknown type");
}

TEST_CASE("a plugin computes the same with the longer structs of a later kernel") {
  const double factor = 3.0;
  shoal_value value{};
  value.n = 1;
  value.reals = &factor;
  const shoal_operator op = build(type_of("sdk_made.total"), 2, value);
  REQUIRE(op.n_relations == 2);
  CHECK(op.body == 1);
  CHECK(op.relations[0].body == 0);
  CHECK(op.relations[1].body == 1);
  CHECK(op.relations[0].cutoff ==
        doctest::Approx(2.2));  // of body 1: the second of an array of longer structs

  // Two particles with weights; the first body has three. Everything is within everything's cut-off.
  constexpr std::size_t padded = 8;
  std::array<double, 2 * padded> position[2] = {{0.5, 0.0, 0.6, 0.1, 0.7, 0.3}, {0.0, 0.0, 0.1, 0.0}};
  std::array<double, padded> weight[2] = {{1.0, 10.0, 100.0}, {1000.0, 10000.0}};
  std::array<double, padded> total{};
  const auto view = [&](const shoal_access& access, std::size_t body) {
    Longer<shoal_field> field;
    const std::string name = access.field;
    field.today.components = access.rank == SHOAL_SCALAR ? 1 : 2;
    field.today.data = name == "position" ? position[body].data()
                       : name == "weight" ? weight[body].data()
                                          : static_cast<void*>(total.data());
    field.today.n_owned = field.today.n_total = body == 0 ? 3 : 2;
    return field;
  };
  std::vector<Longer<shoal_field>> own, of_neighbours;
  for (std::uint32_t a = 0; a < op.n_accesses; ++a) own.push_back(view(op.accesses[a], 1));
  for (std::size_t body = 0; body < 2; ++body)
    for (std::uint32_t a = 0; a < op.n_accesses; ++a) of_neighbours.push_back(view(op.accesses[a], body));

  // Rows of two particles, padded with their last neighbour.
  const std::uint64_t offsets[] = {0, padded};
  const std::uint32_t counts[2][2] = {{3, 2}, {1, 1}};
  const std::uint32_t indices[2][2 * padded] = {{0, 1, 2, 2, 2, 2, 2, 2, 0, 2, 2, 2, 2, 2, 2, 2},
                                                {1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}};
  std::vector<Longer<shoal_neighbours>> lists(2);
  for (std::uint32_t r = 0; r < 2; ++r) {
    lists[r].today.body = r;
    lists[r].today.offsets = offsets;
    lists[r].today.counts = counts[r];
    lists[r].today.indices = indices[r];
    lists[r].today.n_rows = 2;
    lists[r].today.cutoff = 2.2;
  }
  Longer<shoal_binding> binding;
  binding.today.dimensions = 2;
  binding.today.n_owned = 2;
  binding.today.own = first(own);
  binding.today.of_neighbours = first(of_neighbours);
  binding.today.neighbours = first(lists);
  Longer<shoal_step> step;
  step.today.dimensions = 2;
  step.today.dt = 0.5;
  Longer<shoal_chunk> chunk;
  chunk.today.end = 2;
  call_plugin("sdk_made", op.name, [&] { return op.bind(op.self, &binding.today); });
  if (op.begin) call_plugin("sdk_made", op.name, [&] { return op.begin(op.self, &step.today); });
  call_plugin("sdk_made", op.name, [&] { return op.run(op.self, &step.today, &chunk.today); });
  CHECK(total[0] == doctest::Approx(3.0 * 0.5 * (111.0 + 10000.0)));
  CHECK(total[1] == doctest::Approx(3.0 * 0.5 * (101.0 + 1000.0)));
  op.destroy(op.self);
}
