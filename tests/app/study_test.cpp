// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Studies: the matrix of runs, orders and the front from errors that are known, going on after a stop, and runs that
// fail beside runs that do not.
#include <array>
#include <cmath>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

// The probe is 1 + factor dx^order, whatever the grains do; so the error of its reference is known.
std::string known_error(const std::string& more = "") {
  std::string text = grains(
      "probes:\n  height: {maximum: {of: \"1 + factor*dx^power + 0*position.x\", body: pile}, every: 10 ms}\n"
      "reference:\n  - {probe: height, exact: 1, error: max, scale: 1, tolerance: 1}\n" +
      more);
  const std::string parameters = "parameters: {dx: 0.1}";
  text.replace(text.find(parameters), parameters.size(), "parameters: {dx: 0.1, power: 2, factor: 1}");
  return text;
}

std::vector<std::vector<std::string>> csv(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> all;
  std::istringstream stream(read(path));
  for (std::string line; std::getline(stream, line);) {
    all.emplace_back(1);
    for (const char c : line)
      if (c == ',')
        all.back().emplace_back();
      else
        all.back().back() += c;
  }
  return all;
}

std::size_t column(const std::vector<std::vector<std::string>>& table, const std::string& name) {
  const auto at = std::find(table[0].begin(), table[0].end(), name);
  REQUIRE(at != table[0].end());
  return static_cast<std::size_t>(at - table[0].begin());
}

}  // namespace

TEST_CASE("a study runs all combinations and finds the orders of known errors") {
  std::filesystem::remove_all("orders");
  write("pile.yaml", known_error());
  const Result result = shoal({"study", "pile.yaml", "--vary", "power=1,2", "--vary", "dx=0.2,0.1,0.05", "-o",
                               "orders", "--want", "height=1.5%"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto table = csv("orders/study.csv");
  REQUIRE(table.size() == 7);
  const std::size_t error = column(table, "height max error"), order = column(table, "height max order");
  for (std::size_t k = 1; k < 7; ++k) {
    const double power = k < 4 ? 1 : 2, dx = std::array{0.2, 0.1, 0.05}[(k - 1) % 3];
    CHECK(table[k][column(table, "dx")] == std::array{"0.2", "0.1", "0.05"}[(k - 1) % 3]);
    CHECK(table[k][column(table, "status")] == "finished");
    CHECK(std::stod(table[k][error]) == doctest::Approx(std::pow(dx, power)));
    CHECK(std::stod(table[k][column(table, "pairs_per_second [1/s]")]) > 1e4);
    if ((k - 1) % 3 == 0)
      CHECK(table[k][order].empty());
    else
      CHECK(std::stod(table[k][order]) == doctest::Approx(power).epsilon(1e-6));
  }
  CHECK(table[3][column(table, "spacing [m]")] == "0.05");
  CHECK(contains(result.out, "2.00"));
  // Only dx^2 meets 1.5 %, at 0.1 and at 0.05. The coarser run is cheaper but for what else the machine does.
  const auto time = column(table, "wall_time [s]");
  const std::string cheaper = std::stod(table[5][time]) <= std::stod(table[6][time]) ? "0.1" : "0.05";
  CHECK(contains(result.out, "cheapest with height max within 1.5 %: power=2_dx=" + cheaper + " ("));
  CHECK(contains(read("orders/study.gnuplot"), "order 2"));
  CHECK(std::filesystem::exists("orders/runs/power=1_dx=0.05/case.yaml"));
}

TEST_CASE("a study goes on where it was, and does not mix cases") {
  std::filesystem::remove_all("again");
  write("pile.yaml", known_error());
  REQUIRE(shoal({"study", "pile.yaml", "--vary", "dx=0.2,0.1", "-o", "again"}).code == 0);
  const auto written = std::filesystem::last_write_time("again/runs/dx=0.2/summary.json");
  const Result more = shoal({"study", "pile.yaml", "--vary", "dx=0.2,0.1,0.05", "-o", "again"});
  REQUIRE(more.code == 0);
  CHECK(contains(more.out, "1/3  dx=0.2  finished already"));
  CHECK(contains(more.out, "3/3  dx=0.05  finished in"));
  CHECK(std::filesystem::last_write_time("again/runs/dx=0.2/summary.json") == written);
  CHECK(csv("again/study.csv").size() == 4);

  write("pile.yaml", known_error() + "# changed\n");
  const Result changed = shoal({"study", "pile.yaml", "--vary", "dx=0.2", "-o", "again"});
  CHECK(changed.code == 2);
  CHECK(contains(changed.err,
                 "again/runs/dx=0.2: error: it holds results of another case, of other settings, or of "
                 "another version"));
  CHECK(contains(changed.err, "replace them with --force"));
  CHECK(shoal({"study", "pile.yaml", "--vary", "dx=0.2", "-o", "again", "--force"}).code == 0);
}

TEST_CASE("a run that is stopped is resumed") {
  std::filesystem::remove_all("stopped");
  write("pile.yaml", known_error());
  REQUIRE(shoal({"study", "pile.yaml", "--vary", "dx=0.2", "-o", "stopped"}).code == 0);
  const std::string whole = read("stopped/runs/dx=0.2/probes/height.csv");
  // The same run, left in the middle with a checkpoint.
  REQUIRE(shoal({"run", "pile.yaml", "--set", "dx=0.2", "-o", "stopped/runs/dx=0.2", "--force", "--until",
                 "0.05"})
              .code == 0);
  const Result result = shoal({"study", "pile.yaml", "--vary", "dx=0.2", "-o", "stopped"});
  CHECK(result.code == 0);
  CHECK(contains(result.out, "dx=0.2  finished in"));
  CHECK(contains(read("stopped/runs/dx=0.2.log"), "50 ms to 0.1 s"));
  CHECK(read("stopped/runs/dx=0.2/probes/height.csv") == whole);
}

TEST_CASE("a run that fails is a line of the table, and the others are kept") {
  std::filesystem::remove_all("failing");
  write("pile.yaml", known_error());
  const Result result =
      shoal({"study", "pile.yaml", "--vary", "physics.0.grains.falling.breakdown=0.05,10", "-o", "failing"});
  CHECK(result.code == 3);
  const auto table = csv("failing/study.csv");
  REQUIRE(table.size() == 3);
  CHECK(table[1][column(table, "status")] == "failed");
  CHECK(table[2][column(table, "status")] == "finished");
  CHECK(contains(result.err, "warning: breakdown=0.05: "));
}

TEST_CASE("what a study is asked is checked before anything runs") {
  std::filesystem::remove_all("asked");
  write("pile.yaml", known_error());
  const auto complaint = [](const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"study", "pile.yaml", "-o", "asked"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Result result = shoal(arguments);
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK(contains(complaint({"--vary", "dx"}), "<--vary dx>: error: it does not say KEY=VALUE,VALUE,..."));
  CHECK(contains(complaint({"--vary", "dx=0.1,"}),
                 "<--vary dx=0.1,>: error: one of the values of 'dx' is empty"));
  CHECK(contains(complaint({"--vary", "dx=0.1,0.1"}), "two values of 'dx' are the same"));
  CHECK(contains(complaint({"--vary", "dy=0.1"}), "dy"));
  CHECK(contains(complaint({"--vary", "dx=0.1", "--want", "1%"}),
                 "<--want 1%>: error: it does not say what error is wanted"));
  CHECK_FALSE(std::filesystem::exists("asked"));
}

TEST_CASE("a case may say what a study varies") {
  std::filesystem::remove_all("named");
  write("pile.yaml", known_error("study: [\"dx=0.2,0.1\"]\n"));
  const Result result = shoal({"study", "pile.yaml", "-o", "named"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto table = csv("named/study.csv");
  REQUIRE(table.size() == 3);
  CHECK(std::stod(table[2][column(table, "height max order")]) == doctest::Approx(2.0));
  // The command line comes first.
  std::filesystem::remove_all("named");
  REQUIRE(shoal({"study", "pile.yaml", "-o", "named", "--vary", "power=3"}).code == 0);
  CHECK(csv("named/study.csv").size() == 2);
}

TEST_CASE("runs that differ by chance alone are compared by their mean") {
  std::filesystem::remove_all("ensemble");
  std::string text = known_error("ensemble: factor=-1,3,7\n");
  const std::string tolerance = "tolerance: 1}";
  write("pile.yaml",
        text.replace(text.find(tolerance), tolerance.size(), "tolerance: 8 %, mean_tolerance: 5 %}"));
  // 1 + 3 dx^2 in the mean: 12 % and 3 % off; the runs' deviations are 4 dx^2.
  std::vector<std::string> words{"study", "pile.yaml", "--vary", "dx=0.2,0.1", "-o", "ensemble"};
  const Result result = shoal(words);
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(csv("ensemble/study.csv").size() == 7);
  const auto means = csv("ensemble/ensemble.csv");
  REQUIRE(means.size() == 3);
  for (const std::size_t k : {1u, 2u}) {
    const double dx = k == 1 ? 0.2 : 0.1;
    CHECK(means[k][column(means, "reference")] == "height max");
    CHECK(means[k][column(means, "runs")] == "3");
    CHECK(std::stod(means[k][column(means, "error of the mean")]) == doctest::Approx(3.0 * dx * dx));
    CHECK(std::stod(means[k][column(means, "deviation of a run")]) == doctest::Approx(4.0 * dx * dx));
    CHECK(std::stod(means[k][column(means, "tolerance")]) == doctest::Approx(0.05));
    CHECK(means[k][column(means, "verdict")] == (k == 1 ? "FAIL" : "pass"));
  }
  CHECK(contains(result.out, "mean over runs"));
  words.emplace_back("--strict");
  CHECK(shoal(words).code == 3);
  // Single runs miss 8 % on the coarse particles only, and one that fails leaves no verdict.
  CHECK(shoal({"study", "pile.yaml", "--vary", "dx=0.1", "-o", "ensemble", "--strict"}).code == 0);
  CHECK(shoal({"study", "pile.yaml", "--ensemble", "physics.0.grains.falling.breakdown=0.05,10", "-o",
               "ensemble"})
            .code == 3);
  const auto left = csv("ensemble/ensemble.csv");
  CHECK(left[1][column(left, "verdict")] == "incomplete");
  const Result twice = shoal({"study", "pile.yaml", "--vary", "factor=1,2", "-o", "ensemble"});
  CHECK(twice.code == 2);
  CHECK(contains(twice.err, "'factor' is varied already"));

  std::filesystem::create_directories("chance");
  write("chance/pile.yaml", read("pile.yaml"));
  REQUIRE(shoal({"report", "chance", "-o", "report", "--results", "chances"}).code == 0);
  const std::string page = read("report/report.md");
  CHECK(contains(page, "| chance/pile | Falling grains | 3 | 3.0 % | 5.0 % | mean of 3: height max |"));
  CHECK(contains(page, "| height max | 3 | 3.0 % | 5.0 % | 4.0 % | pass |"));
}

TEST_CASE("without an ensemble a study is strict with each of its runs") {
  std::filesystem::remove_all("strict");
  std::string text = known_error();
  const std::string tolerance = "tolerance: 1}";
  write("pile.yaml", text.replace(text.find(tolerance), tolerance.size(), "tolerance: 2 %}"));
  CHECK(shoal({"study", "pile.yaml", "--vary", "dx=0.1,0.05", "-o", "strict", "--strict"}).code == 0);
  CHECK(shoal({"study", "pile.yaml", "--vary", "dx=0.2,0.1", "-o", "strict"}).code == 0);
  CHECK(shoal({"study", "pile.yaml", "--vary", "dx=0.2,0.1", "-o", "strict", "--strict"}).code == 3);
}

namespace {

// Grains that only decay, v' = -c v by explicit Euler: stable for steps below 2 / c, which the factor 2 gives.
std::string decaying(const std::string& more) {
  std::string text =
      grains("probes:\n  speed: {maximum: {of: velocity.magnitude, body: pile}, every: 1 ms}\n" + more,
             "bodies: [pile], damping: 2e4, stiffness: 0", "0.01");
  const std::string gravity = "gravity: [0, -9.81]\n";
  return text.erase(text.find(gravity), gravity.size());
}

}  // namespace

TEST_CASE("a study finds the longest stable step, where it is known") {
  std::filesystem::remove_all("limits");
  write("pile.yaml", decaying(""));
  const Result result = shoal({"study", "pile.yaml", "--limits", "-o", "limits"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto table = csv("limits/limits.csv");
  REQUIRE(table.size() == 2);
  CHECK(table[1][0] == "physics.0.grains.falling.step_factor");
  CHECK(table[1][column(table, "default")] == "1");
  const double holds = std::stod(table[1][column(table, "holds_to")]),
               fails = std::stod(table[1][column(table, "fails_at")]);
  CHECK(holds < 2.0);
  CHECK(fails > 2.0);
  CHECK(fails == doctest::Approx(1.1 * holds).epsilon(1e-3));
  CHECK(contains(table[1][column(table, "why")], "speed [m/s] of speed reaches "));
  CHECK(contains(result.out, "step_factor"));
  // What has run is not run again.
  const Result again = shoal({"study", "pile.yaml", "--limits", "-o", "limits"});
  CHECK(contains(again.out, "limit  step_factor=1.949  finished already"));
  CHECK(csv("limits/limits.csv") == table);
}

TEST_CASE("any key may be raised, with the values that the case names for it") {
  std::filesystem::remove_all("limits");
  std::string text = decaying(
      "reference:\n  - {probe: speed, exact: 0, error: max, scale: 1, tolerance: 1}\nlimits: "
      "[run.end=0.004]\n");
  const std::string run = "run: {end: 0.01}";
  write("pile.yaml",
        text.replace(text.find(run), run.size(), "run: {end: 0.01, time_step_factors: {motion: 1}}"));
  const Result result =
      shoal({"study", "pile.yaml", "-o", "limits", "--limit", "run.time_step_factors.motion=1.5"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto table = csv("limits/limits.csv");
  REQUIRE(table.size() == 2);
  CHECK(table[1][column(table, "holds_to")] == "1.997");
  CHECK(table[1][column(table, "fails_at")] == "2.196");
  CHECK(contains(table[1][column(table, "why")], "speed max misses its reference by "));
  CHECK(contains(read("limits/limits/default/case.yaml"), "end: 0.004"));
  CHECK_FALSE(contains(read("limits/runs/run/case.yaml"), "end: 0.004"));
}

TEST_CASE("what a study is asked of limits is checked before anything runs") {
  std::filesystem::remove_all("asked");
  write("pile.yaml", decaying(""));
  const auto complaint = [](const std::string& limit) {
    const Result result = shoal({"study", "pile.yaml", "-o", "asked", "--limit", limit});
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK(contains(complaint("dx"),
                 "<--limit dx>: error: 'dx' is not declared as a factor of time steps, so it needs a value\n"
                 "      where to begin: --limit dx=VALUE\n"
                 "      declared by the physics: physics.0.grains.falling.step_factor"));
  CHECK(contains(complaint("dx=-1"), "<--limit dx=-1>: error: the value to begin with must be positive"));
  CHECK(contains(complaint("dy=1"), "dy"));
  CHECK_FALSE(std::filesystem::exists("asked"));
}

TEST_CASE("a study keeps within its time and goes on with more") {
  std::filesystem::remove_all("within");
  write("pile.yaml", known_error("output:\n  - grains.tables: {every: 5 ms, pause: 0.1}\n"));
  std::vector<std::string> words{"study", "pile.yaml", "--vary",   "dx=0.2,0.1",
                                 "-o",    "within",    "--within", "0.7 s"};
  const Result result = shoal(words);
  INFO(result.err);
  CHECK(result.code == 0);
  auto table = csv("within/study.csv");
  REQUIRE(table.size() == 3);
  CHECK(table[1][column(table, "status")].starts_with("stopped at "));
  CHECK(table[2][column(table, "status")] == "left out");
  for (const std::size_t k : {1u, 2u}) CHECK(table[k][column(table, "height max error")].empty());
  CHECK(contains(result.err, "warning: dx=0.1: 0.7 s were over"));
  words.pop_back();
  words.push_back("1 min");
  CHECK(shoal(words).code == 0);
  CHECK(contains(read("within/runs/dx=0.2.log"), " ms to 0.1 s"));
  table = csv("within/study.csv");
  CHECK(table[1][column(table, "status")] == "finished");
  CHECK(table[2][column(table, "status")] == "finished");
  CHECK(std::stod(table[2][column(table, "height max order")]) == doctest::Approx(2.0));
}

TEST_CASE("a report holds what its cases give, and runs nothing twice") {
  std::filesystem::remove_all("report");
  std::filesystem::remove_all("studies");
  std::filesystem::create_directories("cases/soft");
  write("cases/soft/pile.yaml", "# Grains with a known error.\n" + known_error("study: [\"dx=0.2,0.1\"]\n"));
  write("cases/soft/broken.yaml",
        grains("", "bodies: [pile], breakdown: 0.05"));  // fails, and has no reference
  const std::vector<std::string> words{"report", "cases", "-o", "report", "--results", "studies"};
  const Result result = shoal(words);
  INFO(result.err);
  CHECK(result.code == 3);
  const std::string page = read("report/report.md");
  CHECK(contains(page, "## soft/pile: Falling grains\n\nGrains with a known error.\n\nPlugins: grains"));
  CHECK(contains(page, "| 0.1 | finished | 200 |"));
  CHECK(contains(page, "| reference | tolerance | dx = 0.2 | dx = 0.1 | last order |"));
  CHECK(contains(page, "| height max | 100 % | 4.0 % | 1.0 % | 2.00 |"));
  CHECK(contains(page, "| soft/pile | Falling grains | 2 | 1.0 % | 100 % | height max | 2.00 |"));
  CHECK(contains(page, "The study ended with exit code 3 (a run failed)."));
  CHECK(contains(page, "grains.repulsion"));
  const std::string html = read("report/report.html");
  CHECK(contains(html, "<td>2.00</td>"));
  CHECK_FALSE(contains(html, "<img"));  // it holds everything itself
  CHECK(std::filesystem::exists("report/soft_pile_error_against_spacing.svg") == contains(html, "<svg"));
  const auto written = std::filesystem::last_write_time("studies/soft_pile/runs/dx=0.1/summary.json");
  CHECK(shoal(words).code == 3);
  CHECK(std::filesystem::last_write_time("studies/soft_pile/runs/dx=0.1/summary.json") == written);
  CHECK(shoal({"report", "nowhere"}).code == 2);

  // With limits, and within a time in which the first case alone is done.
  const std::string seconds = std::to_string(2 * slower) + " s";
  write("cases/soft/decay.yaml",
        decaying("output:\n  - grains.tables: {every: 1 ms, pause: " + std::to_string(0.5 * slower) + "}\n"));
  write("cases/soft/broken.yaml", decaying(""));
  shoal({"report", "cases", "-o", "report", "--results", "bounded", "--limits", "--within", seconds});
  const std::string bounded = read("report/report.md");
  CHECK(contains(bounded, "; each case within " + seconds));
  CHECK(contains(bounded, "| soft/broken | Falling grains | 1 | no reference |  |  |  |"));
  CHECK(contains(bounded, "| step_factor 1.949 (1) |"));
  CHECK(contains(bounded, "| step_factor | 1 | 1.949 | 2.144 | speed [m/s] of speed reaches "));
  CHECK(contains(bounded, "| soft/decay | Falling grains | 1 | stopped at "));
}
