// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with the diffusion plugin: the same bits on one thread, on two and after a restart; plans in which only
// what the case asks for stands; and what it says to cases that cannot be.
#include <set>

#include "kernel/particles/parallel.hpp"
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

constexpr std::uint64_t particles = 80 * 80;
static_assert(particles > shoal::kernel::serial_below, "else no thread but one is ever used");

std::string plate(const std::string& physics, const std::string& material, const std::string& more = "") {
  return "shoal: 1\n"
         "plugins: [diffusion]\n"
         "dimensions: 2\n"
         "resolution: 1/80\n"
         "bodies:\n"
         "  plate:\n"
         "    shape: {box: {lower: [0, 0], upper: [1, 1]}}\n"
         "    arrangement: relaxed\n"
         "    material: {" +
         material +
         "}\n"
         "    initial: {temperature: \"exp(-50*(x-0.4)^2-30*(y-0.6)^2)\"}\n"
         "physics:\n"
         "  - diffusion.diffusion:\n"
         "      bodies: [plate]\n" +
         physics + "run: {end: 10 ms}\n" + more;
}
const std::string fibres = "diffusion.medium: {diffusivity: 1 + x, fibre: [1, y], across: 0.2}";
const std::string surface =
    "      boundaries: [diffusion.fixed_value: {where: y < 1e-6, value: sin(100*t)}]\n"
    "      source: [cos(3*x)*t]\n";
const std::string probes =
    "probes:\n"
    "  content: {sum: {of: temperature*volume, body: plate}, every: 0.2 ms}\n"
    "  highest: {maximum: {of: temperature, body: plate}, every: 0.2 ms}\n";

// All fields of all particles in the newest checkpoint; before them stand wall times and counts of built lists.
std::string final_fields(const std::string& folder) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/checkpoints"))
    files.insert(entry.path());
  REQUIRE_FALSE(files.empty());
  const std::string text = read(*files.rbegin());
  const std::size_t first_body = text.find(std::string("body\0", 5));
  REQUIRE(first_body != std::string::npos);
  return text.substr(first_body);
}

void check_same(const std::string& a, const std::string& b) {
  CAPTURE(a);
  CAPTURE(b);
  for (const char* probe : {"content", "highest"}) {
    const std::string table = read(a + "/probes/" + probe + ".csv");
    CHECK(rows(a + "/probes/" + probe + ".csv").size() > 5);
    CHECK(table == read(b + "/probes/" + probe + ".csv"));
  }
  const std::string fields = final_fields(a);
  CHECK(fields.size() > particles * 40);
  const bool same = fields == final_fields(b);  // else doctest would print all of them
  CHECK(same);
}

std::string plan_of(const std::string& text) {
  write("plan.yaml", text);
  const Result result = app_test::shoal({"plan", "plan.yaml"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  return result.out;
}

std::string error_of(const std::string& text) {
  write("wrong.yaml", text);
  const Result result = app_test::shoal({"plan", "wrong.yaml"});
  CHECK(result.code == 2);
  return result.err;
}

}  // namespace

TEST_CASE("the same bits on one thread and two, and after two restarts, with every integrator") {
  for (const char* integrator : {"auto", "rk2", "rkl2"}) {
    CAPTURE(integrator);
    write("plate.yaml", plate(surface + "      integrator: " + integrator + "\n", fibres, probes));
    REQUIRE(app_test::shoal({"run", "plate.yaml", "-o", "one", "--force", "--threads", "1"}).code == 0);
    REQUIRE(app_test::shoal({"run", "plate.yaml", "-o", "two", "--force", "--threads", "2"}).code == 0);
    check_same("one", "two");
    REQUIRE(
        app_test::shoal({"run", "plate.yaml", "-o", "parts", "--force", "--threads", "2", "--until", "0.003"})
            .code == 0);
    REQUIRE(app_test::shoal({"resume", "parts", "--threads", "1", "--steps", "3"}).code == 0);
    REQUIRE(app_test::shoal({"resume", "parts", "--threads", "2"}).code == 0);
    check_same("one", "parts");
  }
}

TEST_CASE("a plan holds what the case asks for, and no more") {
  const std::string plain = plan_of(
      plate("      scheme: conservative\n      integrator: rk2\n", "diffusion.medium: {diffusivity: 1}"));
  for (const char* part : {"surface", "source", "start_rate", "normal", "signed_distance", "matrix"})
    CHECK_FALSE_MESSAGE(contains(plain, part), part);
  CHECK(contains(plain, "diffusion.rk2"));
  const std::string all = plan_of(plate(surface, fibres));
  for (const char* part : {"diffusion.rate.surface", "diffusion.source", "temperature_start_rate", "normal",
                           "temperature_conductivity  matrix", "rkl2 where its stages"})
    CHECK_MESSAGE(contains(all, part), part);
}

TEST_CASE("several species at once are each as if they were alone; a tensor may come from a field") {
  const std::string both = "    initial:\n      a: \"exp(-50*(x-0.4)^2)\"\n      b: \"cos(3*y)\"\n";
  const auto run = [&](const std::string& fields, const std::string& medium, const std::string& initial) {
    std::string text = plate("      fields: " + fields + "\n      integrator: rk2\n", medium,
                             "probes:\n  a: {sum: {of: a^2, body: plate}, every: 1 ms}\n"
                             "  b: {sum: {of: b^2, body: plate}, every: 1 ms}\n");
    const std::size_t at = text.find("    initial:"), end = text.find("physics:");
    text.replace(at, end - at, initial);
    if (!contains(fields, "a"))
      text.replace(text.find("  a: {sum"), text.find("  b: {sum") - text.find("  a: {sum"), "");
    if (!contains(fields, "b")) text.erase(text.find("  b: {sum"));
    write("species.yaml", text);
    const Result result =
        app_test::shoal({"run", "species.yaml", "-o", "species", "--force", "--set", "resolution=0.05"});
    INFO(result.err);
    REQUIRE(result.code == 0);
  };
  const auto last = [](const char* probe) {
    return rows(std::string("species/probes/") + probe + ".csv").back();
  };
  run("[a, b]", "diffusion.medium: {diffusivity: [1, 0.5]}", both);
  const auto a = last("a"), b = last("b");
  // Alone the step is that of the species, which differs for the slower one.
  run("[a]", "diffusion.medium: {diffusivity: 1}", "    initial: {a: \"exp(-50*(x-0.4)^2)\"}\n");
  CHECK(last("a") == a);
  run("[b, a]", "diffusion.medium: {diffusivity: [0.5, 1]}", both);
  CHECK(last("b") == b);

  run("[a, b]", "diffusion.medium: {diffusivity: 1, tensor: [1, 0.2, 0.5]}", both);
  const auto by_numbers = last("b");
  run("[a, b]", "diffusion.medium: {diffusivity: 1, tensor_field: fibre_tensor}",
      both + "      fibre_tensor: [1, 0.2, 0.2, 0.5]\n");
  CHECK(last("b") == by_numbers);
  CHECK(by_numbers != b);
}

TEST_CASE("what cannot be is refused with the place and what to do") {
  const std::string medium = "diffusion.medium: {diffusivity: 1}";
  CHECK(contains(error_of(plate("", "diffusion.medium: {diffusivity: 1, tensor: [1, 0]}")),
                 "a symmetric tensor has 3 components (xx, xy, yy), not 2"));
  CHECK(contains(error_of(plate("", "diffusion.medium: {diffusivity: 1, fibre: [1, 0]}")),
                 "fibre and across belong together, e.g. fibre: [1, 0], across: 0.1"));
  CHECK(contains(
      error_of(plate("", "diffusion.medium: {diffusivity: 1, tensor: [1, 0, 1], fibre: [1, 0], across: 1}")),
      "give one of tensor, fibre and tensor_field, not several"));
  CHECK(contains(
      error_of(plate("      boundaries: [diffusion.diffusion: {bodies: [plate]}]\n", medium)),
      "diffusion.diffusion is no condition at a surface; there are diffusion.fixed_value, diffusion.flux "
      "and diffusion.convection"));
  CHECK(contains(error_of(plate("  - diffusion.flux: {flux: 1}\n", medium)),
                 "conditions at surfaces stand under 'boundaries' of diffusion.diffusion"));
  CHECK(contains(error_of(plate("      inside: advection\n", medium)),
                 "expected loop/stage, e.g. advection/forces, got 'advection'"));
  CHECK(contains(
      error_of(plate("      gradient_correction: true\n", medium)),
      "gradient_correction is for scheme: conservative without boundaries; scheme: accurate needs none"));
  write("negative.yaml", plate("", "diffusion.medium: {diffusivity: x - 0.5}"));
  const Result negative = app_test::shoal({"run", "negative.yaml", "-o", "negative", "--force"});
  CHECK(negative.code == 2);
  CHECK(contains(negative.err, "the coefficient of diffusion of 'temperature' is not positive at ("));
  std::string without = plate("", medium);
  without.replace(without.find("    material: {" + medium + "}\n"), 16 + medium.size() + 1, "");
  CHECK(contains(error_of(without),
                 "body 'plate' needs a medium: material: {diffusion.medium: {diffusivity: ...}}"));
}
