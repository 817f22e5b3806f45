// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a user reads when a case of solids is wrong, word for word. Values of materials that do not fit together:
// materials/energies_test.cpp; contact: contact/program_test.cpp.
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

struct Block {
  std::string physics = "";
  std::string scheme = "solid.total_lagrangian: {bodies: [block]}";
  std::string material = "{solid.neo_hookean: {density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.3}}";
  std::string domain = "";
  bool in_space = false;
};

// The message in front of the line that it shows.
std::string refusal(const Block& block) {
  write("block.yaml", std::string("shoal: 1\nplugins: [solid]\ndimensions: ") + (block.in_space ? "3" : "2") +
                          "\nresolution: 0.1\n" + block.domain +
                          "bodies:\n  block:\n    shape: {box: {lower: " +
                          (block.in_space ? "[0, 0, 0], upper: [1, 1, 1]" : "[0, 0], upper: [1, 1]") +
                          "}}\n    material: " + block.material + "\nphysics:\n  - " + block.scheme +
                          "\n  - " + block.physics + "\nrun: {end: 1 ms}\n");
  const Result result = app_test::shoal({"run", "block.yaml", "-o", "block", "--force"});
  CHECK(result.code == 2);
  return result.err.substr(0, result.err.find('\n'));
}

}  // namespace

TEST_CASE("constraints") {
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1, axes: [z]}"}) ==
        "block.yaml:11:5: error: block.yaml:11:58: there is no axis z in two dimensions");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x > 2}"}) ==
        "error: operator solid.clamp on body 'block' failed in begin: block.yaml:11:43: no particle of the "
        "body lies in "
        "the region, which is of positions before deformation");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], within: {ball: {centre: [3, 3], radius: 1}}}"}) ==
        "error: operator solid.clamp on body 'block' failed in begin: block.yaml:11:44: no particle of the "
        "body lies in "
        "the region, which is of positions before deformation");
  CHECK(refusal({.physics = "solid.prescribed_motion: {bodies: [block], where: x < 0.1}"}) ==
        "block.yaml:11:5: error: solid.prescribed_motion needs either a displacement or a velocity, e.g. "
        "displacement: "
        "[\"0.1*t\", 0]");
  CHECK(refusal({.physics =
                     "solid.prescribed_motion: {bodies: [block], velocity: [0, 0], displacement: [0, 0]}"}) ==
        "block.yaml:11:5: error: solid.prescribed_motion needs either a displacement or a velocity, e.g. "
        "displacement: "
        "[\"0.1*t\", 0]");
}

TEST_CASE("bodies that are built in") {
  CHECK(
      refusal({.physics =
                   "solid.clamp: {bodies: [block], where: x < 0.1, built_into: {ball: {centre: [0, 0], "
                   "radius: 0.3}}}"}) ==
      "block.yaml:11:5: error: block.yaml:11:64: built_into holds all that is in its shape, along all axes; "
      "leave out where, within and axes, or make another solid.clamp of them");
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], built_into: {ball: {centre: [3, 3], radius: 1}}}"}) ==
        "error: operator solid.clamp on body 'block' failed in begin: block.yaml:11:48: no particle of the "
        "body lies in the region, which is of positions before deformation");
}

TEST_CASE("loads") {
  CHECK(refusal({.physics = "solid.traction: {bodies: [block], where: x > 0.5}"}) ==
        "block.yaml:11:5: error: solid.traction needs either a traction or a force, e.g. traction: [0, "
        "\"1e4*min(t, 1)\"]");
  CHECK(refusal({.physics = "solid.pressure: {bodies: [block], where: x > 4, pressure: 1}"}) ==
        "error: operator solid.pressure_load on body 'block' failed in begin: block.yaml:11:46: no particle "
        "of the body "
        "lies in the region, which is of positions before deformation");
  CHECK(refusal({.physics = "solid.point_force: {bodies: [block], at: [5, 5], force: [1, 0]}"}) ==
        "error: operator solid.point_force on body 'block' failed in begin: block.yaml:11:46: no particle "
        "lies around "
        "the point of the force");
  CHECK(
      refusal({.physics = "solid.torque: {bodies: [block], torque: 1, axis: [0, 0, 0]}", .in_space = true}) ==
      "block.yaml:11:5: error: block.yaml:11:54: the axis of a torque has no direction");
}

TEST_CASE("bodies") {
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .material = "{solid.neo_hookean: {density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.5}}"}) ==
        "block.yaml:8:87: error: 'poisson_ratio' must be less than 0.5, got 0.5");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .domain = "domain: {lower: [0, 0], upper: [1, 1], periodic: [x]}\n"}) ==
        "error: operator solid.reference_weights on body 'block' failed in begin: a solid body reaches a "
        "periodic or "
        "mirror face of the domain, which solids do not know; leave room, or hold the particles of a plane "
        "of symmetry "
        "with solid.clamp and its axes");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.quasi_static: {bodies: [block], loaded_at: 2}"}) ==
        "block.yaml:10:5: error: block.yaml:10:54: loaded_at is behind the end of the run");
  CHECK(
      refusal(
          {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
           .scheme = "solid.total_lagrangian: {bodies: [block], average_volume: always}",
           .material =
               "{solid.st_venant_kirchhoff: {density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.3}}"}) ==
      "block.yaml:10:5: error: block.yaml:10:63: the material of body 'block' does not keep volume and shape "
      "apart, so there is no pressure to average; solid.neo_hookean (form: split) and solid.mooney_rivlin "
      "do");
}
