// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program with reactions: a third party's model, stimuli, activation times, the order of the splitting, the energy
// of Allen and Cahn, and what a user reads when something is wrong.
#include <cmath>
#include <numbers>

#include "kernel/particles/parallel.hpp"
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

std::string square(const std::string& plugins, const std::string& initial, const std::string& physics,
                   const std::string& end, const std::string& more = "") {
  return "shoal: 1\n"
         "plugins: [" +
         plugins +
         "]\n"
         "dimensions: 2\n"
         "parameters: {dx: 0.1, tau: 0.1, beta: 2}\n"
         "resolution: $dx\n"
         "bodies:\n"
         "  plate:\n"
         "    shape: {box: {lower: [0, 0], upper: [1, 1]}}\n"
         "    material: {diffusion.medium: {diffusivity: 0.01}}\n"
         "    initial: {" +
         initial +
         "}\n"
         "physics:\n" +
         physics + "run: {end: " + end + "}\n" + more;
}

const std::string chain_physics =
    "  - diffusion.reaction: {bodies: [plate], model: {chain.decay: {first: 2, second: 0.5}}}\n";
const std::string chain_probes =
    "probes:\n"
    "  a: {mean: {of: a, body: plate}, every: 0.1}\n"
    "  b: {mean: {of: b, body: plate}, every: 0.1}\n"
    "  c: {mean: {of: c, body: plate}, every: 0.1}\n";

double last_value(const std::string& folder, const std::string& probe) {
  const auto table = rows(folder + "/probes/" + probe + ".csv");
  REQUIRE_FALSE(table.empty());
  return table.back().at(1);
}

void run(const std::string& folder, const std::string& text, std::vector<std::string> more = {}) {
  write(folder + ".yaml", text);
  std::vector<std::string> arguments{"run", folder + ".yaml", "-o", folder, "--force"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Result result = app_test::shoal(arguments);
  INFO(result.out);
  INFO(result.err);
  REQUIRE(result.code == 0);
}

}  // namespace

TEST_CASE("a model of a third party's plugin runs in the reaction, with the values of its rest") {
  run("chain", square("diffusion, chain", "b: 0.25", chain_physics, "2", chain_probes));
  const auto table = rows("chain/probes/b.csv");
  for (const auto& row : table) {
    const double t = row[0], a = std::exp(-2 * t);
    const double b = 0.25 * std::exp(-0.5 * t) + 2.0 / 1.5 * (std::exp(-0.5 * t) - a);
    CHECK(std::fabs(row[1] - b) < 2e-3);
  }
  CHECK(std::fabs(last_value("chain", "a") - std::exp(-4.0)) < 1e-6);
  // What is there at the beginning is there at the end.
  CHECK(std::fabs(last_value("chain", "a") + last_value("chain", "b") + last_value("chain", "c") - 1.25) <
        2e-3);
}

TEST_CASE("reaction and diffusion split are of second order in time") {
  // dc/dt = D lap c - c^3 written through Allen-Cahn has no closed solution: the steps are compared with very small ones.
  const std::string physics =
      "  - diffusion.diffusion: {bodies: [plate], fields: [phase]}\n"
      "  - diffusion.reaction: {bodies: [plate], model: diffusion.allen_cahn, adaptive: false, time_step: "
      "$tau}\n";
  const auto value = [&](const std::string& step) {
    run("split",
        square("diffusion", "phase: \"0.9*cos(pi*x)\"", physics, "1.6",
               "probes: {p: {point: {of: phase, at: [0.35, 0.55], body: plate}, every: 1.6}}\n"),
        {"--set", "parameters.tau=" + step});
    return last_value("split", "p");
  };
  const double exact = value("0.0025"), coarse = std::fabs(value("0.2") - exact),
               fine = std::fabs(value("0.1") - exact), finest = std::fabs(value("0.05") - exact);
  CHECK(coarse > 1e-6);
  CHECK(std::log2(coarse / fine) > 1.7);
  CHECK(std::log2(fine / finest) > 1.8);
}

TEST_CASE("a stimulus excites the tissue that it reaches, and activation times follow the wave") {
  const std::string physics =
      "  - diffusion.diffusion: {bodies: [plate], fields: [potential]}\n"
      "  - diffusion.reaction:\n"
      "      bodies: [plate]\n"
      "      model: {diffusion.fitzhugh_nagumo: {a: 0.1, epsilon: 0.005, time_scale: 0.1}}\n"
      "      stimuli: [{diffusion.stimulus: {upper: [0.3, 2], rate: 5, start: 1, duration: 0.25}}]\n"
      "      activation_threshold: 0.5\n";
  const std::string probes =
      "probes:\n"
      "  near: {mean: {of: activation_time, body: plate, where: x < 0.1}, every: 0.5}\n"
      "  middle: {mean: {of: activation_time, body: plate, where: abs(x - 0.55) < 0.05}, every: 0.5}\n"
      "  far: {mean: {of: activation_time, body: plate, where: x > 0.9}, every: 0.5}\n"
      "  number: {maximum: {of: activations, body: plate}, every: 0.5}\n"
      "  cycle: {maximum: {of: mean_cycle_length, body: plate}, every: 0.5}\n";
  run("wave", square("diffusion", "potential: 0", physics, "8", probes));
  CHECK(rows("wave/probes/near.csv").front()[1] == -1.0);  // nothing has risen yet
  CHECK(rows("wave/probes/number.csv").front()[1] == 0.0);
  CHECK(last_value("wave", "number") == 1.0);  // no second wave, hence no cycle
  CHECK(last_value("wave", "cycle") == 0.0);
  const double near = last_value("wave", "near"), middle = last_value("wave", "middle"),
               far = last_value("wave", "far");
  CHECK(near > 1.05);
  CHECK(near < 1.3);  // the stimulus alone lifts it to 1 in 0.2 s
  CHECK(middle > near + 0.1);
  CHECK(far > middle + 0.1);
  CHECK(far < 8.0);

  write("plan.yaml", square("diffusion", "potential: 0", physics, "8"));
  const Result plan = app_test::shoal({"plan", "plan.yaml"});
  CHECK(contains(plan.out, "not computed, since nothing asks for it: diffusion.not_activated on plate"));
  CHECK_FALSE(contains(plan.out, "activation_potential"));
}

TEST_CASE("a stimulus that comes again gives the cycle its length") {
  const std::string physics =
      "  - diffusion.reaction:\n"
      "      bodies: [plate]\n"
      "      model: {diffusion.fitzhugh_nagumo: {time_scale: 0.002}}\n"
      "      stimuli: [{diffusion.stimulus: {rate: 100, start: 0.1, duration: 0.01, period: 1.25}}]\n"
      "      activation_threshold: 0.5\n";
  run("paced", square("diffusion", "potential: 0", physics, "5",
                      "probes:\n"
                      "  number: {minimum: {of: activations, body: plate}, every: 1}\n"
                      "  cycle: {mean: {of: mean_cycle_length, body: plate}, every: 1}\n"
                      "  last: {mean: {of: last_activation, body: plate}, every: 1}\n"));
  CHECK(last_value("paced", "number") == 4.0);
  CHECK(last_value("paced", "cycle") == doctest::Approx(1.25).epsilon(1e-3));
  CHECK(last_value("paced", "last") == doctest::Approx(3.855).epsilon(1e-3));
}

TEST_CASE("a reaction written in the case as expressions") {
  // The Brusselator, with a parameter of the case, a name of place and a decay; against small steps of Euler's method.
  const auto physics = [](const std::string& decays) {
    return "  - diffusion.reaction:\n"
           "      bodies: [plate]\n"
           "      model: {diffusion.formula: {variables: [u, v], step: 0.05, tolerance: 1e-5, " +
           decays + "}}\n";
  };
  const std::string split = "rates: [\"1 + u^2*v + 0*x\", \"beta*u - u^2*v\"], decays: [\"beta + 1\", 0]";
  const std::string whole = "rates: [\"1 + u^2*v - (beta + 1)*u\", \"beta*u - u^2*v\"]";
  double u = 0.5, v = 1.0;
  for (int k = 0; k < 400000; ++k) {
    const double du = 1 + u * u * v - 3.0 * u, dv = 2.0 * u - u * u * v;
    u += 1e-5 * du;
    v += 1e-5 * dv;
  }
  for (const std::string& rates : {split, whole}) {
    const std::string text =
        square("diffusion", "u: 0.5, v: 1", physics(rates), "4",
               "probes: {u: {mean: {of: u, body: plate}, every: 1}, v: {mean: {of: v, body: "
               "plate}, every: 1}}\n");
    run("formula", text);
    CHECK(last_value("formula", "u") == doctest::Approx(u).epsilon(2e-3));
    CHECK(last_value("formula", "v") == doctest::Approx(v).epsilon(2e-3));
  }
}

TEST_CASE("a wave has the same bits on one thread, on two, and after it was stopped") {
  const std::string physics =
      "  - diffusion.diffusion: {bodies: [plate], fields: [potential], scheme: conservative, integrator: "
      "rk2}\n"
      "  - diffusion.reaction:\n"
      "      bodies: [plate]\n"
      "      model: {diffusion.ten_tusscher_panfilov: {cell: mid}}\n"
      "      stimuli: [{diffusion.stimulus: {upper: [0.2, 2], rate: 60, duration: 2 ms}}]\n";
  const std::string text = square("diffusion", "potential: -0.085", physics, "4 ms",
                                  "probes:\n"
                                  "  v: {mean: {of: potential, body: plate}, every: 0.2 ms}\n"
                                  "  h: {maximum: {of: gate_h, body: plate}, every: 0.2 ms}\n"
                                  "  a: {mean: {of: activation_time, body: plate}, every: 0.2 ms}\n");
  static_assert(72 * 72 > shoal::kernel::serial_below, "else no thread but one is ever used");
  run("one", text, {"--set", "dx=1/72", "--threads", "1"});
  run("two", text, {"--set", "dx=1/72", "--threads", "2"});
  run("stopped", text, {"--set", "dx=1/72", "--threads", "2", "--until", "0.0017"});
  const Result resumed = app_test::shoal({"resume", "stopped", "--threads", "1"});
  INFO(resumed.err);
  REQUIRE(resumed.code == 0);
  for (const char* probe : {"v", "h", "a"}) {
    const std::string table = read(std::string("one/probes/") + probe + ".csv");
    CHECK(rows(std::string("one/probes/") + probe + ".csv").size() > 15);
    CHECK(table == read(std::string("two/probes/") + probe + ".csv"));
    CHECK(table == read(std::string("stopped/probes/") + probe + ".csv"));
  }
  CHECK(last_value("one", "v") > -0.085);  // something has happened
}

TEST_CASE("what a user reads when a reaction is described wrongly") {
  const auto error = [](const std::string& reaction) {
    write("wrong.yaml", square("diffusion, chain", "b: 0",
                               "  - diffusion.reaction: {bodies: [plate], " + reaction + "}\n", "1"));
    const Result result = app_test::shoal({"run", "wrong.yaml", "-o", "wrong"});
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK(contains(error("model: chain.stone"),
                 ": chain.stone is no reaction model; take one that offers 'reaction_model', e.g. "
                 "diffusion.aliev_panfilov"));
  const auto formula = [&](const std::string& rest) {
    return error("model: {diffusion.formula: {variables: [u, v], step: 1, " + rest + "}}");
  };
  CHECK(contains(formula("rates: [u, w]"), "unknown name 'w'; variables of the formula: u, v"));
  CHECK(contains(formula("rates: [u]"), "there are 2 variables, but 1 rates; give one for each"));
  CHECK(contains(formula("rates: [u, v], decays: [1, 2, 3]"),
                 "there are 2 variables, but 3 decays; give one for each, 0 where there is none"));
  CHECK(contains(formula("rates: [\"u +\", v]"), "the expression ends too early"));
  CHECK(contains(error("model: diffusion.allen_cahn, stimuli: [chain.stone]"),
                 "chain.stone is no stimulus; write {diffusion.stimulus: {...}}"));
  CHECK(contains(
      error(
          "model: diffusion.allen_cahn, stimuli: [{diffusion.stimulus: {rate: 1, duration: 2, period: 1}}]"),
      "the period is shorter than the duration; a stimulus must end before it begins again"));
  CHECK(contains(
      error(
          "model: diffusion.allen_cahn, stimuli: [{diffusion.stimulus: {rate: 1, duration: 2, lower: [1, 0], "
          "upper: [0, 1]}}]"),
      "the upper corner lies below the lower one; swap them"));
}
