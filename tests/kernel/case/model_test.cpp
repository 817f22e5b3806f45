// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A whole case: its model, the effective case that gives the same model again, and what the tables say of it.
#include "kernel/case/model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/case/describe.hpp"
#include "kernel/case/effective.hpp"
#include "kernel/case/sections.hpp"
#include "test_types.hpp"

namespace {

using namespace shoal::kernel;

const char* const full_case =
    "shoal: 1\n"
    "title: 'Dam break: \"wall\" \\ yes'\n"
    "plugins: [fluid, vtk]\n"
    "dimensions: 2\n"
    "parameters: {H: 1 m, dx: 25 mm, U: 2*H, w: 3 W/m2}\n"
    "resolution: $dx\n"
    "gravity: [0, -9.81]\n"
    "domain: {lower: [-1, 0], upper: [H, inf], periodic: x, mirror: [lower_y]}\n"
    "smoothing: {ratio: 1.5}\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [2*H, H]}}\n"
    "    material: {fluid.liquid: {density: 1000, permeability: [[1, 0.1], [0, 1/3]], label: 'no'}}\n"
    "    initial: {velocity: ['U*y/H', 0], pressure: 1 atm, own_field: [1, 'x + t', 3]}\n"
    "  tank:\n"
    "    shape: {shell: {of: {box: {lower: [0, 0], upper: [5.366*H, 2.5*H]}}, thickness: 4*dx}}\n"
    "    material: fluid.wall\n"
    "    resolution: dx/3\n"
    "    arrangement: hexagonal\n"
    "    smoothing_kernel: cubic_spline\n"
    "  drops: {shape: {union: {of: [{ball: {radius: 1 mm}}, {polygon: {vertices: [[0, 0], [1, 0], [0, "
    "1]]}}]}}}\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water], walls: [tank], inflow: ['1 - y^2', 0], heating: 3, times: [0.1, 1 "
    "ms]}\n"
    "  - fluid.wcsph: {bodies: drops}\n"
    "run: {end: 2 s, time_step_factors: {acoustic: 50 %, advection: 0.25}, checkpoint_every: 0.1}\n"
    "output:\n"
    "  - vtk: {every: 50 ms, fields: [velocity, pressure]}\n"
    "  - vtk\n"
    "probes:\n"
    "  front: {maximum: {of: position.x, body: water}, every: 5 ms}\n"
    "  energy: {energy: , every: 1}\n"
    "reference:\n"
    "  - {probe: front, data: data.csv, time_scale: sqrt(H/9.81), error: max, tolerance: 5 %}\n"
    "  - {probe: energy, exact: exp(-2*t), tolerance: 0.01, from: 0.1, to: 1, scale: 2}\n";

struct Loaded {
  test::TestTypes types;
  Diagnostics diagnostics;
  std::unique_ptr<CaseModel> model;

  explicit Loaded(const std::string& text, const std::vector<std::string>& settings = {}) {
    std::ofstream("data.csv") << "0,1\n";
    const CaseFile file(text, "full.yaml", ".", settings, diagnostics);
    CHECK(diagnostics.format() == "");
    REQUIRE(file.readable());
    model = check_case(file, types, diagnostics);
    CHECK(diagnostics.format() == "");
  }
};

TEST_CASE("the model holds what the case says, in SI units") {
  const Loaded loaded(full_case);
  const CaseModel& model = *loaded.model;
  CHECK(model.title == "Dam break: \"wall\" \\ yes");
  CHECK(model.plugins.size() == 2);
  CHECK(model.plugins[1].id == "vtk");
  CHECK(model.plugins[1].place.text() == "full.yaml:3:18");
  CHECK(model.dimensions == 2);
  CHECK(model.resolution == 0.025);
  CHECK(model.gravity == std::array<double, 3>{0, -9.81, 0});
  CHECK(model.domain.lower[0] == -1);
  CHECK(model.domain.upper[0] == 1);
  CHECK(std::isinf(model.domain.upper[1]));
  CHECK(std::isinf(model.domain.lower[2]));
  CHECK(model.domain.periodic == std::array<bool, 3>{true, false, false});
  CHECK(model.domain.mirror_lower == std::array<bool, 3>{false, true, false});
  CHECK(model.domain.mirror_upper == std::array<bool, 3>{false, false, false});
  REQUIRE(model.bodies.size() == 3);
  const BodyModel& water = model.bodies[0];
  CHECK(water.name == "water");
  CHECK(water.place == "full.yaml:11:3");
  CHECK(water.resolution == 0.025);
  CHECK(water.arrangement == "cubic");
  CHECK(water.smoothing_kernel == "wendland_c2");
  CHECK(water.smoothing_ratio == 1.5);
  REQUIRE(water.initial.size() == 3);
  CHECK(water.initial[0].field == "velocity");
  CHECK(water.initial[0].components.size() == 2);
  const double point[] = {0.0, 0.5};
  double out = 0;
  water.initial[0].components[0].evaluate(2, 1, point, 0, &out);
  CHECK(out == 1.0);
  CHECK(water.initial[1].components[0].value() == doctest::Approx(101325));
  CHECK(water.initial[2].components.size() == 3);
  const BodyModel& tank = model.bodies[1];
  CHECK(tank.resolution == doctest::Approx(0.025 / 3));
  CHECK(tank.arrangement == "hexagonal");
  CHECK(tank.smoothing_kernel == "cubic_spline");
  CHECK(model.bodies[2].material == nullptr);
  CHECK(model.physics.size() == 2);
  CHECK(model.outputs.size() == 2);
  CHECK(model.run.end == 2);
  REQUIRE(model.run.time_step_factors.size() == 2);
  CHECK(model.run.time_step_factors[0] == std::pair<std::string, double>{"acoustic", 0.5});
  CHECK(model.run.checkpoint_every == 0.1);
  REQUIRE(model.probes.size() == 2);
  CHECK(model.probes[0].name == "front");
  CHECK(model.probes[0].every == 0.005);
  CHECK(model.probes[0].object->type == &loaded.types.type("maximum"));
  REQUIRE(model.references.size() == 2);
  CHECK(model.references[0].data == std::filesystem::absolute("data.csv").string());
  CHECK(model.references[0].time_scale == std::sqrt(1 / 9.81));
  CHECK(model.references[0].error == "max");
  CHECK(model.references[0].tolerance == doctest::Approx(0.05));
  CHECK_FALSE(model.references[0].exact);
  CHECK(model.references[1].exact->text() == "exp(-2*t)");
  CHECK(model.references[1].to == 1.0);
  CHECK(model.references[1].scale == 2.0);
}

TEST_CASE("settings of the command line reach the model") {
  const Loaded loaded(full_case, {"H=0.5m", "run.end=1", "bodies.water.material.fluid.liquid.density=900",
                                  "physics.0.fluid.wcsph.walls=[]"});
  const CaseModel& model = *loaded.model;
  CHECK(model.run.end == 1);
  CHECK(model.domain.upper[0] == 0.5);
  const shoal_object& liquid = *model.bodies[0].material;
  const shoal_value& density = *find_value(liquid, model.store.table(liquid), "density");
  CHECK(density.reals[0] == 900);
  CHECK(density.origin == SHOAL_ORIGIN_COMMAND_LINE);
  CHECK(density.place == std::string("<--set bodies.water.material.fluid.liquid.density=900>"));
}

// Compares everything that a plugin could see, but places and origins.
void check_same(const shoal_object& a, const shoal_object& b, const Loaded& of_a, int dimensions);

void check_same(const shoal_value& a, const shoal_value& b, const shoal_parameter& parameter,
                const Loaded& of_a, int dimensions) {
  INFO(parameter.key);
  REQUIRE(a.kind == b.kind);
  REQUIRE(a.n == b.n);
  const auto d = static_cast<std::uint32_t>(dimensions);
  const std::uint32_t per = a.kind == SHOAL_VECTOR || a.kind == SHOAL_VECTOR_EXPRESSION ? d
                            : a.kind == SHOAL_MATRIX                                    ? d * d
                                                                                        : 1;
  std::uint32_t n_expressions = a.n * per;
  if (a.kind == kind_field_map) {
    n_expressions = 0;
    for (std::uint32_t k = 0; k < a.n; ++k) n_expressions += static_cast<std::uint32_t>(a.integers[k]);
  }
  CHECK((a.reals == nullptr) == (b.reals == nullptr));
  CHECK((a.expressions == nullptr) == (b.expressions == nullptr));
  for (std::uint32_t k = 0; a.reals != nullptr && k < a.n * per; ++k) CHECK(a.reals[k] == b.reals[k]);
  for (std::uint32_t k = 0; a.integers != nullptr && k < a.n; ++k) CHECK(a.integers[k] == b.integers[k]);
  for (std::uint32_t k = 0; a.texts != nullptr && k < a.n; ++k) CHECK(a.texts[k] == std::string(b.texts[k]));
  for (std::uint32_t k = 0; a.objects != nullptr && k < a.n; ++k)
    check_same(*a.objects[k], *b.objects[k], of_a, dimensions);
  for (std::uint32_t k = 0; a.expressions != nullptr && k < n_expressions; ++k) {
    const double points[] = {0.3, 0.7, 1.1, -0.2};
    double at_a[2], at_b[2];
    Expression::from_handle(a.expressions[k]).evaluate(2, 2, points, 0.4, at_a);
    Expression::from_handle(b.expressions[k]).evaluate(2, 2, points, 0.4, at_b);
    CHECK(at_a[0] == at_b[0]);
    CHECK(at_a[1] == at_b[1]);
  }
}

void check_same(const shoal_object& a, const shoal_object& b, const Loaded& of_a, int dimensions) {
  const shoal_type& table = of_a.model->store.table(a);
  CHECK(table.name == std::string(b.type->name));
  REQUIRE(a.n_values == b.n_values);
  for (std::uint32_t k = 0; k < a.n_values; ++k)
    check_same(a.values[k], b.values[k], table.parameters[k], of_a, dimensions);
}

void check_same(const Loaded& a, const Loaded& b) {
  const CaseModel& x = *a.model;
  const CaseModel& y = *b.model;
  const auto same = [&](const shoal_object* left, const shoal_object* right) {
    REQUIRE((left == nullptr) == (right == nullptr));
    if (left != nullptr) check_same(*left, *right, a, x.dimensions);
  };
  same(x.values, y.values);
  same(x.smoothing, y.smoothing);
  same(x.domain.values, y.domain.values);
  same(x.run.values, y.run.values);
  REQUIRE(x.bodies.size() == y.bodies.size());
  for (std::size_t k = 0; k < x.bodies.size(); ++k) {
    CHECK(x.bodies[k].name == y.bodies[k].name);
    same(x.bodies[k].values, y.bodies[k].values);
  }
  REQUIRE(x.probes.size() == y.probes.size());
  for (std::size_t k = 0; k < x.probes.size(); ++k) {
    CHECK(x.probes[k].name == y.probes[k].name);
    same(x.probes[k].object, y.probes[k].object);
    same(x.probes[k].values, y.probes[k].values);
  }
  REQUIRE(x.references.size() == y.references.size());
  for (std::size_t k = 0; k < x.references.size(); ++k) same(x.references[k].values, y.references[k].values);
  REQUIRE(x.parameters.all().size() == y.parameters.all().size());
  for (std::size_t k = 0; k < x.parameters.all().size(); ++k) {
    CHECK(x.parameters.all()[k].value == y.parameters.all()[k].value);
    CHECK(x.parameters.all()[k].unit == y.parameters.all()[k].unit);
  }
}

TEST_CASE("the effective case gives the same model, and the same effective case but for origins") {
  for (const std::vector<std::string>& settings :
       {std::vector<std::string>{}, {"H=0.5m", "physics.0.fluid.wcsph.walls=[]"}}) {
    const Loaded first(full_case, settings);
    const std::string text = effective_case(*first.model);
    INFO(text);
    const Loaded second(text);
    check_same(first, second);
  }
}

TEST_CASE("the effective case says where each value came from") {
  const Loaded loaded(full_case, {"run.end=1"});
  const std::string text = effective_case(*loaded.model);
  const auto has_line = [&](const std::string& content, const std::string& comment) {
    const std::size_t at = text.find("\n" + content + " ");
    INFO(content);
    REQUIRE(at != std::string::npos);
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    CHECK(line.substr(line.find("# ")) == "# " + comment);
  };
  has_line("resolution: 0.025", "m, full.yaml:6");
  has_line("  ratio: 1.5", "full.yaml:9");
  has_line("  kernel: wendland_c2", "default");
  has_line("  end: 1", "s, --set");
  has_line("  dx: 0.025 m", "full.yaml:5: 25 mm");
  has_line("        density: 1000", "kg/m3, full.yaml:13");
  has_line("        temperature: 293.15", "K, default");
  has_line("        label: \"no\"", "full.yaml:13");
  CHECK(text.find("        # sound_speed: not set\n") != std::string::npos);
}

TEST_CASE("texts are written so that they are texts again") {
  for (const char* text :
       {"",     "no",   "true", "null", "~",        "a b",  "1",       "010",      "-",
        "a: b", "#x",   "'",    "\"",   "\\",       "*a",   "&a",      "[a]",      "{",
        "a\nb", "a\tb", "%",    "@",    "\xC3\xA9", "word", "a/b.csv", "/tmp/x y", "$dx"}) {
    Diagnostics diagnostics;
    const Node root = read_yaml_text("a: " + yaml_text(text) + "\n", "a.yaml", diagnostics);
    INFO(text);
    CHECK(diagnostics.format() == "");
    REQUIRE(root.find("a")->is_scalar());
    CHECK(root.find("a")->text() == text);
  }
  CHECK(yaml_text("velocity.x") == "velocity.x");  // no quotes where none are needed
}

TEST_CASE("a case without dimensions is not complained about for its vectors") {
  Diagnostics diagnostics;
  const CaseFile file(
      "shoal: 1\nresolution: 1\ngravity: [0, 0, -1]\nbodies: {a: {shape: {ball: {radius: 1}}}}\nrun: {end: "
      "1}\n",
      "a.yaml", ".", {}, diagnostics);
  check_case(file, test::TestTypes(), diagnostics);
  CHECK(diagnostics.n_errors() == 1);
  CHECK(diagnostics.sorted()[0].message == "missing key 'dimensions' in case");
}

TEST_CASE("dimensions may be a parameter") {
  const Loaded loaded(
      "shoal: 1\nparameters: {D: 3}\ndimensions: $D\nresolution: 1\ngravity: [0, 0, -1]\n"
      "bodies: {a: {shape: {ball: {radius: 1}}}}\nrun: {end: 1}\n");
  CHECK(loaded.model->dimensions == 3);
  CHECK(loaded.model->gravity[2] == -1);
}

TEST_CASE("merge keys serve a case, and notes are the user's") {
  const Loaded loaded(
      "shoal: 1\nx-note: {anything: [goes, 1]}\ndimensions: 2\nresolution: 1\n"
      "x-wall: &wall {material: fluid.wall, resolution: 0.5}\n"
      "bodies:\n"
      "  x-old: {shape: nothing}\n"
      "  left: {<<: *wall, shape: {ball: {radius: 1}}}\n"
      "  right: {<<: *wall, resolution: 0.25, shape: {ball: {radius: 2}}}\n"
      "run: {end: 1}\n");
  REQUIRE(loaded.model->bodies.size() == 2);
  CHECK(loaded.model->bodies[0].resolution == 0.5);
  CHECK(loaded.model->bodies[1].resolution == 0.25);
}

// ------------------------------------------------------------------------------------------------------------

TEST_CASE("the kernel's own tables are as sound as those of plugins") {
  for (const shoal_type* table : section_tables()) {
    INFO(table->name);
    CHECK(table->doc != nullptr);
    for (std::uint32_t k = 0; k < table->n_parameters; ++k) {
      const shoal_parameter& parameter = table->parameters[k];
      INFO(parameter.key);
      CHECK(parameter.doc != nullptr);
      CHECK(parameter.example != nullptr);
      if (parameter.kind <= SHOAL_OBJECT) CHECK(check_parameter(parameter) == "");
    }
  }
}

TEST_CASE("a type is described in aligned columns") {
  const test::TestTypes types;
  CHECK(describe_type(types.type("ball"), "shape of the kernel", 80) ==
        "ball  (shape of the kernel)\n"
        "A ball, a disc in two dimensions.\n"
        "\n"
        "  key     value      default    meaning\n"
        "  radius  number, m  required   Radius. Must be greater than 0 m.\n"
        "                                Example: radius: 0.5 m\n"
        "  centre  vector, m  [0, 0, 0]  Centre.\n"
        "                                Example: centre: [0, 1]\n");
  CHECK(describe_type(types.type("fluid.wall")) ==
        "fluid.wall  (material)\n"
        "A wall.\n"
        "\n"
        "  It has no keys.\n");
  for (const shoal_type* type : types.all()) {
    std::istringstream lines(describe_type(*type, "", 100));
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 100);
  }
}

TEST_CASE("the JSON schema has every section, type and key") {
  const test::TestTypes types;
  const nlohmann::json schema = nlohmann::json::parse(json_schema(types.all()));
  CHECK(schema["additionalProperties"] == false);
  for (const std::string& key : section_keys()) CHECK(schema["properties"].contains(key));
  CHECK(schema["required"] == nlohmann::json::array({"shoal", "dimensions", "resolution", "bodies", "run"}));
  const nlohmann::json& liquid =
      schema["definitions"]["material"]["anyOf"][1]["properties"]["fluid.liquid"]["anyOf"][0];
  CHECK(liquid["required"] == nlohmann::json::array({"density"}));
  CHECK(liquid["additionalProperties"] == false);
  CHECK(liquid["properties"]["density"]["anyOf"][0]["exclusiveMinimum"] == 0.0);
  CHECK(liquid["properties"]["iterations"]["anyOf"][0]["type"] == "integer");
  CHECK(liquid["properties"]["density"]["description"] == "Density at rest. [kg/m3]");
  CHECK(liquid["properties"]["equation_of_state"]["enum"] ==
        nlohmann::json::array({"tait", "linear", "stiffened"}));
  const nlohmann::json& shell = schema["definitions"]["shape"]["anyOf"][1]["properties"]["shell"]["anyOf"][0];
  CHECK(shell["properties"]["of"]["allOf"][0]["$ref"] == "#/definitions/shape");
  const std::string text = schema.dump();
  for (const shoal_type* type : types.all())
    CHECK(text.find("\"" + std::string(type->name) + "\"") != std::string::npos);
}

}  // namespace
