// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Settings of the command line on the tree. Their errors are in broken/set_*.
#include "kernel/case/overrides.hpp"

#include <doctest/doctest.h>

namespace {

using namespace shoal::kernel;

const char* const text =
    "parameters: {H: 1 m, run: 3}\n"
    "bodies:\n"
    "  water:\n"
    "    material: {fluid.liquid: {density: 1000}}\n"
    "  tank:\n"
    "    material: fluid.wall\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water]}\n"
    "  - solid.elastic\n"
    "run: {end: 2}\n";

std::string show(const Node& node) {
  if (node.is_scalar()) return node.text();
  if (node.is_null()) return "~";
  std::string result;
  if (node.is_sequence()) {
    for (const Node& item : node.items()) result += (result.empty() ? "" : ", ") + show(item);
    return "[" + result + "]";
  }
  for (const Node::Entry& entry : node.entries())
    result += (result.empty() ? "" : ", ") + entry.key + ": " + show(entry.value);
  return "{" + result + "}";
}

// The section after the settings.
std::string after(const std::vector<std::string>& settings, const char* section) {
  Diagnostics diagnostics;
  const Node root = read_yaml_text(text, "a.yaml", diagnostics);
  const Node changed = apply_overrides(root, settings, {"run", "domain", "output", "title"}, diagnostics);
  CHECK(diagnostics.format() == "");
  CHECK(show(*root.find("run")) == "{end: 2}");  // the tree that was read does not change
  const Node* found = changed.find(section);
  return found == nullptr ? "absent" : show(*found);
}

TEST_CASE("values are set by path") {
  CHECK(after({"run.end=1"}, "run") == "{end: 1}");
  CHECK(after({"run.end=1 ms"}, "run") == "{end: 1 ms}");
  CHECK(after({"title=a=b"}, "title") == "a=b");
  CHECK(after({"run.steps=[1, 2]"}, "run") == "{end: 2, steps: [1, 2]}");
  CHECK(
      after({"bodies.tank.resolution=0.1"}, "bodies") ==
      "{water: {material: {fluid.liquid: {density: 1000}}}, tank: {material: fluid.wall, resolution: 0.1}}");
}

TEST_CASE("names of types are found although they hold points") {
  CHECK(after({"bodies.water.material.fluid.liquid.density=900"}, "bodies") ==
        "{water: {material: {fluid.liquid: {density: 900}}}, tank: {material: fluid.wall}}");
  CHECK(after({"physics.fluid.wcsph.viscosity=1e-3"}, "physics") ==
        "[{fluid.wcsph: {bodies: [water], viscosity: 1e-3}}, solid.elastic]");
}

TEST_CASE("a type that stands alone takes values too") {
  CHECK(after({"physics.solid.elastic.damping=1"}, "physics") ==
        "[{fluid.wcsph: {bodies: [water]}}, {solid.elastic: {damping: 1}}]");
  CHECK(after({"bodies.tank.material.fluid.wall.slip=true"}, "bodies") ==
        "{water: {material: {fluid.liquid: {density: 1000}}}, tank: {material: {fluid.wall: {slip: true}}}}");
}

TEST_CASE("items of lists are found by their place") {
  CHECK(after({"physics.0.fluid.wcsph.bodies.0=tank"}, "physics") ==
        "[{fluid.wcsph: {bodies: [tank]}}, solid.elastic]");
  CHECK(after({"physics.1=solid.rigid"}, "physics") == "[{fluid.wcsph: {bodies: [water]}}, solid.rigid]");
}

TEST_CASE("a single word that is a parameter means the parameter") {
  CHECK(after({"H=0.5m"}, "parameters") == "{H: 0.5m, run: 3}");
  CHECK(after({"parameters.H=2"}, "parameters") == "{H: 2, run: 3}");
  CHECK(after({"parameters.new=2"}, "parameters") == "{H: 1 m, run: 3, new: 2}");
  CHECK(after({"run=5"}, "parameters") == "{H: 1 m, run: 5}");
}

TEST_CASE("sections that the file leaves out are made") {
  CHECK(after({"domain.periodic=[x]"}, "domain") == "{periodic: [x]}");
  CHECK(after({"output.vtk.every=1"}, "output") == "{vtk: {every: 1}}");
}

TEST_CASE("later settings win, and see what earlier ones made") {
  CHECK(after({"run.end=1", "run.end=5"}, "run") == "{end: 5}");
  CHECK(after({"domain.lower=[0, 0]", "domain.lower.1=2"}, "domain") == "{lower: [0, 2]}");
}

TEST_CASE("what was set knows that it was") {
  Diagnostics diagnostics;
  const Node root = read_yaml_text(text, "a.yaml", diagnostics);
  const Node changed = apply_overrides(root, {"run.end=1"}, {"run"}, diagnostics);
  const Node& run = *changed.find("run");
  CHECK(run.place().line_text() == "a.yaml:10");
  CHECK(run.find("end")->place().text() == "<--set run.end=1>");
  CHECK(is_command_line(run.find("end")->place()));
  CHECK_FALSE(is_command_line(run.place()));
  CHECK(run.entries()[0].key_place.text() == "<--set run.end=1>");
}

}  // namespace
