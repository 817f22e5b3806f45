// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Values as plugins receive them, defaults and origins, and the check of tables. Errors are in broken/.
#include "kernel/case/schema.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "kernel/case/overrides.hpp"
#include "test_types.hpp"

namespace {

using namespace shoal::kernel;

struct Fixture {
  test::TestTypes types;
  Diagnostics diagnostics;
  Parameters parameters{read_yaml_text("p: {H: 2 m, n: 3}\n", "p.yaml", diagnostics).entries()[0].value,
                        diagnostics};
  ObjectStore store;
  int dimensions = 2;

  const shoal_object* read(const std::string& text, shoal_type_kind kind) {
    const Node root = read_yaml_text("object: " + text + "\n", "a.yaml", diagnostics);
    const SchemaContext context{dimensions, parameters, types, {"water", "tank"}, ".", store, diagnostics};
    return read_typed_object(root.entries()[0].value, kind, context);
  }
  const shoal_object* good(const std::string& text, shoal_type_kind kind) {
    const shoal_object* object = read(text, kind);
    CHECK(diagnostics.format() == "");
    REQUIRE(object != nullptr);
    return object;
  }
  const shoal_value& value(const shoal_object* object, const char* key) {
    const shoal_value* found = find_value(*object, store.table(*object), key);
    REQUIRE(found != nullptr);
    return *found;
  }
};

TEST_CASE_FIXTURE(Fixture, "values of every kind arrive in SI units, in the order of the table") {
  std::ofstream("water.csv") << "1,2\n";
  const shoal_object* liquid = good(
      "{fluid.liquid: {density: 1 g/cm3, sound_speed: 10*H, equation_of_state: linear, free_surface: false, "
      "iterations: n, porosity: 30 %, permeability: [[1, 2], [3, 4]], table: water.csv, label: 'a b'}}",
      SHOAL_TYPE_MATERIAL);
  CHECK(liquid->type == &types.type("fluid.liquid"));
  CHECK(liquid->n_values == types.type("fluid.liquid").n_parameters);
  CHECK(liquid->place == std::string("a.yaml:1:10"));
  const auto real = [&](const char* key) { return value(liquid, key).reals[0]; };
  CHECK(real("density") == doctest::Approx(1000).epsilon(1e-14));
  CHECK(real("sound_speed") == 20);
  CHECK(real("porosity") == doctest::Approx(0.3));
  CHECK(value(liquid, "equation_of_state").integers[0] == 1);
  CHECK(value(liquid, "equation_of_state").texts[0] == std::string("linear"));
  CHECK(value(liquid, "free_surface").integers[0] == 0);
  CHECK(value(liquid, "iterations").integers[0] == 3);
  CHECK(value(liquid, "label").texts[0] == std::string("a b"));
  CHECK(std::filesystem::path(value(liquid, "table").texts[0]).is_absolute());
  const shoal_value& matrix = value(liquid, "permeability");
  CHECK(matrix.n == 1);
  for (int k = 0; k < 4; ++k) CHECK(matrix.reals[k] == k + 1);
  for (std::uint32_t k = 0; k < liquid->n_values; ++k) {
    CHECK(liquid->values[k].size == sizeof(shoal_value));
    CHECK(liquid->values[k].kind == types.type("fluid.liquid").parameters[k].kind);
  }
  std::filesystem::remove("water.csv");
}

TEST_CASE_FIXTURE(Fixture, "what is left out has its default, or is not set") {
  const shoal_object* liquid = good("{fluid.liquid: {density: 1000}}", SHOAL_TYPE_MATERIAL);
  CHECK(value(liquid, "viscosity").n == 1);
  CHECK(value(liquid, "viscosity").reals[0] == 0);
  CHECK(value(liquid, "viscosity").origin == SHOAL_ORIGIN_DEFAULT);
  CHECK(value(liquid, "temperature").reals[0] == doctest::Approx(293.15));
  CHECK(value(liquid, "pressure_limit").reals[0] == std::numeric_limits<double>::infinity());
  CHECK(value(liquid, "equation_of_state").texts[0] == std::string("tait"));
  CHECK(value(liquid, "sound_speed").n == 0);
  CHECK(value(liquid, "sound_speed").reals == nullptr);
  CHECK(value(liquid, "density").origin == SHOAL_ORIGIN_CASE);
  CHECK(value(liquid, "density").place == std::string("a.yaml:1:34"));
}

TEST_CASE_FIXTURE(Fixture, "infinity is a value where it is the default, and only there") {
  CHECK(
      value(good("{fluid.liquid: {density: 1, pressure_limit: inf}}", SHOAL_TYPE_MATERIAL), "pressure_limit")
          .reals[0] == std::numeric_limits<double>::infinity());
  CHECK(value(good("{fluid.liquid: {density: 1, pressure_limit: 1 bar}}", SHOAL_TYPE_MATERIAL),
              "pressure_limit")
            .reals[0] == 1e5);
  read("{fluid.liquid: {density: inf}}", SHOAL_TYPE_MATERIAL);
  CHECK(diagnostics.n_errors() == 1);
}

TEST_CASE_FIXTURE(Fixture, "vectors have as many numbers as the case dimensions, also their defaults") {
  const shoal_object* plane = good("{ball: {radius: 1}}", SHOAL_TYPE_SHAPE);
  CHECK(value(plane, "centre").n == 1);
  dimensions = 3;
  const shoal_object* space = good("{ball: {radius: 1, centre: [1, 2 cm, H]}}", SHOAL_TYPE_SHAPE);
  CHECK(value(space, "centre").reals[0] == 1);
  CHECK(value(space, "centre").reals[1] == doctest::Approx(0.02));
  CHECK(value(space, "centre").reals[2] == 2);
}

TEST_CASE_FIXTURE(Fixture, "one value counts as a list of one, for vectors too") {
  const shoal_object* flow = good("{fluid.wcsph: {bodies: tank, times: [1, 2 ms, n]}}", SHOAL_TYPE_PHYSICS);
  CHECK(value(flow, "bodies").n == 1);
  CHECK(value(flow, "bodies").integers[0] == 1);
  CHECK(value(flow, "bodies").texts[0] == std::string("tank"));
  CHECK(value(flow, "walls").n == 0);
  CHECK(value(flow, "times").n == 3);
  CHECK(value(flow, "times").reals[2] == 3);
  const shoal_value one = value(good("{polygon: {vertices: [1, 2]}}", SHOAL_TYPE_SHAPE), "vertices");
  CHECK(one.n == 1);
  CHECK(one.reals[1] == 2);
  const shoal_value three =
      value(good("{polygon: {vertices: [[0, 1], [2, 3], [4, 5]]}}", SHOAL_TYPE_SHAPE), "vertices");
  CHECK(three.n == 3);
  for (int k = 0; k < 6; ++k) CHECK(three.reals[k] == k);
  CHECK(value(good("{polygon: {vertices: []}}", SHOAL_TYPE_SHAPE), "vertices").n == 0);
}

TEST_CASE_FIXTURE(Fixture, "expressions arrive as handles that the kernel can evaluate") {
  const shoal_object* flow = good(
      "{fluid.wcsph: {bodies: water, inflow: ['1 - (y/H)^2', 0.5 cm/s], heating: x*t}}", SHOAL_TYPE_PHYSICS);
  const shoal_value& inflow = value(flow, "inflow");
  CHECK(inflow.n == 1);
  const double point[] = {3.0, 1.0};
  double out = 0;
  Expression::from_handle(inflow.expressions[0]).evaluate(2, 1, point, 0, &out);
  CHECK(out == 0.75);
  CHECK(Expression::from_handle(inflow.expressions[1]).value() == doctest::Approx(0.005));
  Expression::from_handle(value(flow, "heating").expressions[0]).evaluate(2, 1, point, 2.0, &out);
  CHECK(out == 6.0);
}

TEST_CASE_FIXTURE(Fixture, "objects nest, by name alone or with values") {
  const shoal_object* active =
      good("{fluid.active: {passive: {fluid.active: {passive: fluid.wall}}}}", SHOAL_TYPE_MATERIAL);
  const shoal_object* inner = value(active, "passive").objects[0];
  CHECK(inner->type == &types.type("fluid.active"));
  CHECK(value(inner, "passive").objects[0]->type == &types.type("fluid.wall"));
  const shoal_object* shapes =
      good("{union: {of: [{ball: {radius: 1}}, {ball: {radius: 2}}]}}", SHOAL_TYPE_SHAPE);
  CHECK(value(shapes, "of").n == 2);
  CHECK(value(value(shapes, "of").objects[1], "radius").reals[0] == 2);
}

TEST_CASE_FIXTURE(Fixture, "keys that begin with x- are the user's") {
  good("{x-note: old, fluid.liquid: {density: 1000, x-source: handbook}}", SHOAL_TYPE_MATERIAL);
}

TEST_CASE_FIXTURE(Fixture, "a null map is all defaults") {
  good("{fluid.wall: }", SHOAL_TYPE_MATERIAL);
  good("fluid.wall", SHOAL_TYPE_MATERIAL);
  read("fluid.liquid", SHOAL_TYPE_MATERIAL);
  CHECK(diagnostics.sorted()[0].message == "missing key 'density' in fluid.liquid");
}

TEST_CASE_FIXTURE(Fixture, "a value that is wrong is not set, and the others are") {
  const shoal_object* liquid = read("{fluid.liquid: {density: -1, viscosity: 2}}", SHOAL_TYPE_MATERIAL);
  CHECK(diagnostics.n_errors() == 1);
  CHECK(value(liquid, "density").n == 0);
  CHECK(value(liquid, "density").reals == nullptr);
  CHECK(value(liquid, "viscosity").reals[0] == 2);
}

TEST_CASE_FIXTURE(Fixture, "types of a plugin that failed to load are passed over in silence") {
  CHECK(read("{absent.material: {density: 1}}", SHOAL_TYPE_MATERIAL) == nullptr);
  const shoal_object* active = read("{fluid.active: {passive: absent.material}}", SHOAL_TYPE_MATERIAL);
  CHECK(value(active, "passive").n == 0);
  CHECK(value(active, "passive").objects == nullptr);
  CHECK(diagnostics.empty());
}

TEST_CASE("names of fields and of their components") {
  for (const char* name : {"velocity", "velocity.x", "x2_y", "stress.xy"}) CHECK(is_field_name(name));
  for (const char* name : {"", "Velocity", "velocity.", ".x", "a.b.c", "2x", "a b", "_a"})
    CHECK_FALSE(is_field_name(name));
}

TEST_CASE("a table's units, defaults and examples are checked when a plugin is registered") {
  const auto check = [](std::uint32_t kind, const char* unit, const char* default_text, const char* example) {
    return check_parameter(test::parameter(kind, "key", unit, 0, default_text, "Doc.", example));
  };
  CHECK(check(SHOAL_REAL, "kg/m3", "1000", "1 g/cm3") == "");
  CHECK(check(SHOAL_REAL, "m", nullptr, "2*dx") == "");  // dx may be a parameter of the case
  CHECK(check(SHOAL_VECTOR, "m", "[0, 0, 0]", "[1, 2]") == "");
  CHECK(check(SHOAL_REAL, "furlongz", "1", nullptr) == "UDUNITS-2 does not know its unit 'furlongz'");
  CHECK(check(SHOAL_REAL, "m", "2 kg", nullptr) ==
        "its default '2 kg' is wrong: expected a length (m), got '2 kg' (mass)");
  CHECK(check(SHOAL_REAL, "m", nullptr, "010") ==
        "its example '010' is wrong: '010' has a leading zero, which other YAML readers take for octal; "
        "write 10");
  CHECK(check(SHOAL_BOOLEAN, nullptr, "yes", nullptr) ==
        "its default 'yes' is wrong: expected true or false, got 'yes', which YAML readers disagree about; "
        "write true");
  CHECK(check(SHOAL_VECTOR, "m", "[0]", nullptr) ==
        "its default '[0]' is wrong: expected a list of 3 numbers, got a list of 1");
  CHECK(check(SHOAL_REAL, "m", "[1, 2", nullptr) ==
        "its default '[1, 2' is not YAML: '[' is never closed; add ']' or a comma between its values");
  const test::TestTypes types;
  for (const shoal_type* type : types.all()) {
    for (std::uint32_t k = 0; k < type->n_parameters; ++k) CHECK(check_parameter(type->parameters[k]) == "");
  }
}

}  // namespace
