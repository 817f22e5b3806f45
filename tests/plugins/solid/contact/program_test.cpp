// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with solids in contact, one of them plastic: the same bits on one thread, on two and after a restart; a
// plan without what is not asked for; and what a user reads.

#include "kernel/particles/parallel.hpp"
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

std::string blocks(const std::string& contact) {
  return "shoal: 1\n"
         "plugins: [solid]\n"
         "dimensions: 2\n"
         "parameters: {dx: 1/100}\n"
         "resolution: $dx\n"
         "bodies:\n"
         "  hard:\n"
         "    shape: {box: {lower: [0, 0], upper: [1, 0.6]}}\n"
         "    material: {solid.neo_hookean: {density: 1000, youngs_modulus: 1e7, poisson_ratio: 0.3}}\n"
         "  soft:\n"
         "    shape: {box: {lower: [0.2, 0.603], upper: [1.2, 1.203]}}\n"
         "    material: {solid.plastic: {density: 1000, youngs_modulus: 1e7, poisson_ratio: 0.3, "
         "yield_stress: 2e5}}\n"
         "    initial: {velocity: [3, -10]}\n"
         "physics:\n"
         "  - solid.total_lagrangian: {bodies: [hard, soft]}\n" +
         contact +
         "  - solid.rigid_plane: {bodies: [hard], point: [0, 0], normal: [0, 1], friction: 0.2}\n"
         "run: {end: 3 ms}\n"
         "probes:\n"
         "  push: {sum: {of: [mass*velocity.x, mass*velocity.y], body: hard}, every: 0.1 ms}\n"
         "  flow: {maximum: {of: equivalent_plastic_strain, body: soft}, every: 0.1 ms}\n";
}
const std::string with_friction = "  - solid.contact: {bodies: [hard, soft], self: [soft], friction: 0.3}\n";

constexpr std::uint64_t particles = 100 * 60;
static_assert(particles > shoal::kernel::serial_below, "else no thread but one is ever used");

void check_same(const std::string& a, const std::string& b) {
  for (const char* probe : {"push", "flow"}) {
    CHECK(rows(a + "/probes/" + probe + ".csv").size() > 20);
    CHECK(read(a + "/probes/" + probe + ".csv") == read(b + "/probes/" + probe + ".csv"));
  }
  const std::string fields = final_fields(a);
  CHECK(fields.size() > 2 * particles * 80);
  const bool same = fields == final_fields(b);  // else doctest would print all of them
  CHECK(same);
}

}  // namespace

TEST_CASE("blocks that hit, slide and flow: the same bits on one thread and two, and after two restarts") {
  write("blocks.yaml", blocks(with_friction));
  const Result one = app_test::shoal({"run", "blocks.yaml", "-o", "one", "--force", "--threads", "1"});
  REQUIRE_MESSAGE(one.code == 0, one.err);
  REQUIRE(app_test::shoal({"run", "blocks.yaml", "-o", "two", "--force", "--threads", "2"}).code == 0);
  check_same("one", "two");
  const auto push = rows("one/probes/push.csv"), flow = rows("one/probes/flow.csv");
  CHECK(push.back()[1] > 0.0);  // dragged along
  CHECK(push.back()[2] < 0.0);  // pushed down
  CHECK(flow.back()[1] > 0.0);

  REQUIRE(
      app_test::shoal({"run", "blocks.yaml", "-o", "parts", "--force", "--threads", "2", "--until", "1.1e-3"})
          .code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "1", "--steps", "7"}).code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "2"}).code == 0);
  check_same("one", "parts");
}

TEST_CASE("normals are in the plan of a case with friction only, self-contact where it is asked for") {
  write("blocks.yaml", blocks(with_friction));
  write("smooth.yaml", blocks("  - solid.contact: {bodies: [hard, soft]}\n"));
  write("apart.yaml", blocks(""));
  const std::string rough = app_test::shoal({"plan", "blocks.yaml"}).out;
  const std::string smooth = app_test::shoal({"plan", "smooth.yaml"}).out;
  const std::string apart = app_test::shoal({"plan", "apart.yaml"}).out;
  CHECK(contains(rough, "solid.contact_friction  on hard with soft"));
  CHECK(contains(rough, "solid.contact_force  on soft with soft"));
  CHECK(contains(rough, "contact_normal_with_hard"));
  CHECK(contains(smooth, "solid.contact_force  on soft with hard"));
  CHECK_FALSE(contains(smooth, "contact_normal"));
  CHECK_FALSE(contains(smooth, "solid.contact_force  on soft with soft"));
  CHECK_FALSE(contains(apart, "solid.contact"));
}

TEST_CASE("what cannot be in contact is refused with the place and the remedy") {
  const auto refusal = [](const std::string& contact) {
    write("wrong.yaml", blocks(contact));
    const Result result = app_test::shoal({"plan", "wrong.yaml"});
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK(contains(
      refusal("  - solid.contact: {bodies: [hard]}\n"),
      "solid.contact needs two bodies that may touch, or one that may touch itself, e.g. {bodies: [tube], "
      "self: [tube]}"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard, hard]}\n"), "names body 'hard' twice"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard, soft], self: [soft, soft]}\n"),
                 "names body 'soft' twice"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard, soft], friction: -0.1}\n"),
                 "'friction' must be at least 0, got -0.1"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard, soft], stiffness: 0}\n"),
                 "'stiffness' must be greater than 0, got 0"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard, soft], self: [soft], self_distance: 2}\n"),
                 "'self_distance' must be at least 3, got 2"));
  CHECK(contains(refusal("  - solid.contact: {bodies: [hard], self: [soft]}\n"),
                 "body 'soft' is not among the bodies in contact"));
  CHECK(contains(refusal("  - solid.rigid_plane: {bodies: [hard], point: [0, 0], normal: [0, 0]}\n"),
                 "the normal of a plane has no direction"));
}
