// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with the diffusion plugin: the same bits on one thread, on two and after a restart; plans in which only
// what the case asks for stands; and what it says to cases that cannot be.

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

TEST_CASE("auto says at the end which integrator it took and why, the same after a restart") {
  const auto says = [](const std::string& out) {
    const std::size_t at = out.find("temperature in plate: ");
    return at == std::string::npos ? out : out.substr(at, out.find('\n', at) - at);
  };
  write("plate.yaml", plate("", fibres));
  const std::vector<std::string> coarse{"--set", "resolution=1/40", "--force"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), coarse.begin(), coarse.end());
    const Result result = app_test::shoal(words);
    INFO(result.err);
    REQUIRE(result.code == 0);
    return says(result.out);
  };
  const std::string whole = run({"run", "plate.yaml", "-o", "whole"});
  CHECK(contains(whole, "temperature in plate: rkl2 in "));
  CHECK(contains(whole, " of the cost of rk2 alone: the accuracy 0.0001 allowed steps of up to "));
  CHECK(contains(read("whole/summary.json"), whole));
  run({"run", "plate.yaml", "-o", "halves", "--until", "0.004"});
  CHECK(says(app_test::shoal({"resume", "halves"}).out) == whole);
  // An accuracy that allows no step longer than the explicit one
  write("plate.yaml", plate("      accuracy: 1e-12\n", fibres));
  CHECK(contains(run({"run", "plate.yaml", "-o", "explicit"}), "temperature in plate: rk2 in all "));
  write("plate.yaml", plate("      integrator: rk2\n", fibres));
  CHECK_FALSE(contains(run({"run", "plate.yaml", "-o", "told"}), "temperature in plate: "));
}

TEST_CASE(
    "the monotone scheme with its limiter gives the same bits on one thread and two, and after a restart") {
  write("plate.yaml", plate(surface + "      scheme: monotone\n",
                            "diffusion.medium: {diffusivity: 1, fibre: [1, 0.5], across: 0.001}", probes));
  REQUIRE(app_test::shoal({"run", "plate.yaml", "-o", "one", "--force", "--threads", "1"}).code == 0);
  REQUIRE(
      app_test::shoal({"run", "plate.yaml", "-o", "parts", "--force", "--threads", "2", "--until", "0.003"})
          .code == 0);
  REQUIRE(app_test::shoal({"resume", "parts", "--threads", "2"}).code == 0);
  check_same("one", "parts");
}

TEST_CASE("a plan holds what the case asks for, and no more") {
  const std::string plain = plan_of(
      plate("      scheme: conservative\n      integrator: rk2\n", "diffusion.medium: {diffusivity: 1}"));
  for (const char* part : {"surface", "source", "start_rate", "normal", "signed_distance", "matrix"})
    CHECK_FALSE_MESSAGE(contains(plain, part), part);
  CHECK(contains(plain, "diffusion.rk2"));
  const std::string all = plan_of(plate(surface, fibres));
  for (const char* part : {"diffusion.rate.surface", "diffusion.source", "temperature_start_rate", "normal",
                           "temperature_conductivity  matrix", "rkl2 where it costs less"})
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

TEST_CASE("what cannot be is refused, word for word, with the place and what to do") {
  const std::string medium = "diffusion.medium: {diffusivity: 1}";
  const auto refused = [](const std::string& text, const std::string& words) {
    const std::string error = error_of(text);
    CHECK(error.substr(0, error.find('\n')) == words);
  };
  refused(plate("", "diffusion.medium: {diffusivity: 1, tensor: [1, 0]}"),
          "wrong.yaml:12:5: error: wrong.yaml:9:59: a symmetric tensor has 3 components (xx, xy, yy), not 2");
  refused(plate("", "diffusion.medium: {diffusivity: 1, fibre: [1, 0]}"),
          "wrong.yaml:12:5: error: wrong.yaml:9:58: fibre and across belong together, e.g. fibre: [1, 0], "
          "across: 0.1");
  refused(plate("", "diffusion.medium: {diffusivity: 1, tensor: [1, 0, 1], fibre: [1, 0], across: 1}"),
          "wrong.yaml:12:5: error: wrong.yaml:9:59: give one of tensor, fibre and tensor_field, not several");
  refused(plate("      boundaries: [diffusion.diffusion: {bodies: [plate]}]\n", medium),
          "wrong.yaml:12:5: error: wrong.yaml:14:20: diffusion.diffusion is no condition at a surface; there "
          "are diffusion.fixed_value, diffusion.flux and diffusion.convection");
  refused(plate("  - diffusion.flux: {flux: 1}\n", medium),
          "wrong.yaml:14:5: error: conditions at surfaces stand under 'boundaries' of diffusion.diffusion");
  refused(plate("      inside: advection\n", medium),
          "wrong.yaml:12:5: error: wrong.yaml:14:15: expected loop/stage, e.g. advection/forces, got "
          "'advection'");
  refused(plate("      gradient_correction: true\n", medium),
          "wrong.yaml:12:5: error: wrong.yaml:14:28: gradient_correction is for scheme: conservative without "
          "boundaries; scheme: accurate needs none");
  refused(plate("      medium: {diffusion.allen_cahn: {}}\n", "diffusion.allen_cahn: {}"),
          "wrong.yaml:12:5: error: wrong.yaml:14:15: diffusion.allen_cahn is no medium for diffusion; there "
          "are diffusion.medium and diffusion.conductor");
  refused(plate("      wave_speed_of: diffusion.fitzhugh_nagumo\n",
                "diffusion.conductor: {conductivity: 1, density: 2, specific_heat: 1}"),
          "wrong.yaml:12:5: error: wrong.yaml:14:22: wave_speed_of works on bodies of diffusion.medium, "
          "whose capacity is 1");
  refused(plate("      wave_speed_of: diffusion.fitzhugh_nagumo\n      scheme: monotone\n", medium),
          "wrong.yaml:12:5: error: wrong.yaml:14:22: wave_speed_of knows the schemes accurate and "
          "conservative, not monotone");
  refused(plate("      wave_speed_of: diffusion.allen_cahn\n", medium),
          "wrong.yaml:12:5: error: wrong.yaml:14:22: diffusion.allen_cahn has no waves that run from where "
          "it is excited; leave wave_speed_of out");
  refused(plate("  - diffusion.reaction: {bodies: [plate], model: {diffusion.medium: {diffusivity: 1}}}\n",
                medium),
          "wrong.yaml:14:5: error: wrong.yaml:14:51: diffusion.medium is no reaction model; take one that "
          "offers 'reaction_model', e.g. diffusion.aliev_panfilov");
  std::string without = plate("", medium);
  without.replace(without.find("    material: {" + medium + "}\n"), 16 + medium.size() + 1, "");
  refused(without,
          "wrong.yaml:11:5: error: body 'plate' needs a medium: material: {diffusion.medium: {diffusivity: "
          "...}}, or, where its material is of another plugin, medium: {diffusion.medium: ...} in "
          "diffusion.diffusion");
  write("negative.yaml", plate("", "diffusion.medium: {diffusivity: x - 0.5}"));
  const Result negative = app_test::shoal({"run", "negative.yaml", "-o", "negative", "--force"});
  CHECK(negative.code == 2);
  const std::size_t open = negative.err.find('('), closed = negative.err.find(')');  // a particle's place
  REQUIRE(closed < negative.err.size());
  CHECK(
      negative.err.substr(0, open + 1) + negative.err.substr(closed) ==
      "error: operator diffusion.coefficient on body 'plate' failed in run: the coefficient of diffusion of "
      "'temperature' is not positive at (); its tensor must be symmetric and positive definite everywhere\n");
}
