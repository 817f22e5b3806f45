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

TEST_CASE("moduli and Poisson's ratios") {
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .material = "{solid.neo_hookean: {density: -1000, youngs_modulus: 1e6, poisson_ratio: 0.3}}"}) ==
        "block.yaml:8:45: error: 'density' must be greater than 0 kg/m3, got -1000");
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .material = "{solid.neo_hookean: {density: 1000, youngs_modulus: -1e6, poisson_ratio: 0.3}}"}) ==
        "block.yaml:8:67: error: 'youngs_modulus' must be greater than 0 Pa, got -1e6");
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .material = "{solid.neo_hookean: {density: 1000, youngs_modulus: .inf, poisson_ratio: 0.3}}"}) ==
        "block.yaml:8:67: error: '.inf' is not allowed here; write a finite number");
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .material = "{solid.neo_hookean: {density: 1000, youngs_modulus: 0/0, poisson_ratio: 0.3}}"}) ==
        "block.yaml:8:67: error: the value of '0/0' is not a number; check for a division by zero or a root "
        "of a negative number");
  CHECK(
      refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
               .material = "{solid.neo_hookean: {density: 1000, youngs_modulus: 1e6, poisson_ratio: -1}}"}) ==
      "block.yaml:8:87: error: 'poisson_ratio' must be greater than -1, got -1");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .material = "{solid.plastic: {density: 1000, youngs_modulus: 1e7, poisson_ratio: 0.3, "
                             "yield_stress: 1e5, hardening: -1}}"}) ==
        "block.yaml:8:118: error: 'hardening' must be at least 0 Pa, got -1");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .material = "{solid.mooney_rivlin: {density: 1000, c1: 1e5, c2: -1, bulk_modulus: 1e6}}"}) ==
        "block.yaml:8:66: error: 'c2' must be at least 0 Pa, got -1");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .material = "{solid.guccione: {density: 1000, c: 1e3, b_f: 8, b_t: 2, b_fs: 4, "
                             "bulk_modulus: 1e5, fibre: [x/0, 0]}}"}) ==
        "error: operator solid.initial_state on body 'block' failed in run: the material needs the direction "
        "'fibre' at every particle, of length 1; give it in the material (fibre: [1, 0, 0]) or as an initial "
        "field of the body");
}

TEST_CASE("the scheme") {
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.total_lagrangian: {bodies: [block], hourglass: -1}"}) ==
        "block.yaml:10:58: error: 'hourglass' must be at least 0, got -1");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.total_lagrangian: {bodies: [block], support: 1.5}"}) ==
        "block.yaml:10:56: error: 'support' must be at least 1.8, got 1.5");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.total_lagrangian: {bodies: [block], step_factor: 1.5}"}) ==
        "block.yaml:10:60: error: 'step_factor' must be at most 1, got 1.5");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.total_lagrangian: {bodies: [block], plane: stress}",
                 .in_space = true}) ==
        "block.yaml:10:5: error: block.yaml:10:54: plane: stress is for two dimensions; leave it out");
  CHECK(refusal(
            {.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
             .scheme = "solid.total_lagrangian: {bodies: [block], plane: stress, average_volume: always}"}) ==
        "block.yaml:10:5: error: block.yaml:10:78: in plane stress a sheet keeps its volume by its "
        "thickness, so there is no pressure to average; leave average_volume out, or take plane: strain");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.total_lagrangian: {bodies: [block, block]}"}) ==
        "block.yaml:10:5: error: block.yaml:10:38: body 'block' is named twice; each solid body has one "
        "solid.total_lagrangian or one solid.quasi_static");
  CHECK(refusal({.physics = "solid.quasi_static: {bodies: [block]}"}) ==
        "block.yaml:11:5: error: block.yaml:11:34: body 'block' is named twice; each solid body has one "
        "solid.total_lagrangian or one solid.quasi_static");
  CHECK(refusal({.physics = "solid.clamp: {bodies: [block], where: x < 0.1}",
                 .scheme = "solid.quasi_static: {bodies: [block], tolerance: 1}"}) ==
        "block.yaml:10:54: error: 'tolerance' must be less than 1, got 1");
}

TEST_CASE("loads and motions that are no numbers, or act on nothing") {
  CHECK(
      refusal(
          {.physics =
               "solid.prescribed_motion: {bodies: [block], where: x < 0.1, displacement: [\"0/t\", 0]}"}) ==
      "error: operator solid.prescribed_motion on body 'block' failed in begin: a value that the case gives "
      "is not a finite number at t = 0 s; check for a division by zero or a root of a negative number");
  CHECK(refusal(
            {.physics =
                 "solid.traction: {bodies: [block], where: x > 0.5, traction: [\"sqrt(-1e-3 - t)\", 0]}"}) ==
        "error: operator solid.traction on body 'block' failed in begin: a value that the case gives is not "
        "a finite number at t = 0.0005 s; check for a division by zero or a root of a negative number");
  CHECK(
      refusal(
          {.physics =
               "solid.point_force: {bodies: [block], at: [0.5, 0.5], force: [\"1/(t < 0 ? 1 : 0)\", 0]}"}) ==
      "error: operator solid.point_force on body 'block' failed in begin: a value that the case gives is not "
      "a finite number at t = 0.0005 s; check for a division by zero or a root of a negative number");
  CHECK(refusal({.physics = "solid.traction: {bodies: [block], where: \"abs(x - 0.5) < 0.11 && abs(y - 0.5) "
                            "< 0.11\", traction: [1, 0]}"}) ==
        "error: operator solid.traction on body 'block' failed in begin: block.yaml:11:46: the region of the "
        "traction holds no surface; it is the particles within 5 spacings of one flat face");
  CHECK(refusal({.physics = "solid.torque: {bodies: [block], torque: 1, where: x < 0.1 && y < 0.1}"}) ==
        "error: operator solid.torque on body 'block' failed in begin: block.yaml:11:55: the particles of "
        "the region lie on the axis of the torque, about which they cannot turn; choose a region of more "
        "particles");
  CHECK(refusal({.physics = "solid.torque: {bodies: [block], torque: 1, axis: [1, 0, 0]}"}) ==
        "block.yaml:11:5: error: block.yaml:11:54: in two dimensions a torque turns about z; leave the axis "
        "out");
}

TEST_CASE("contact with walls") {
  CHECK(refusal({.physics = "solid.rigid_plane: {bodies: [block], point: [0, -1], normal: [0, 0]}"}) ==
        "block.yaml:11:5: error: block.yaml:11:66: the normal of a plane has no direction");
  CHECK(refusal({.physics =
                     "solid.rigid_plane: {bodies: [block], point: [0, -1], normal: [0, 1], friction: -1}"}) ==
        "block.yaml:11:84: error: 'friction' must be at least 0, got -1");
  CHECK(refusal({.physics =
                     "solid.rigid_plane: {bodies: [block], point: [0, -1], normal: [0, 1], stiffness: 0}"}) ==
        "block.yaml:11:85: error: 'stiffness' must be greater than 0, got 0");
}
