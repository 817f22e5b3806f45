// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the commands print, leave behind and return.
#include <set>

#include "tests/app/support.hpp"

using namespace app_test;

TEST_CASE("run leaves the effective case, tables, a checkpoint and a summary") {
  std::filesystem::remove_all("results");
  write("pile.yaml", grains("probes:\n  height: {mean: {of: position.y, body: pile}, every: 10 ms}\n"
                            "output:\n  - grains.tables: {every: 50 ms, fields: [velocity]}\n"
                            "reference:\n  - {probe: height, exact: \"1\", error: max, tolerance: 50 %}\n"));
  const Result result = shoal({"run", "pile.yaml"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  CHECK(contains(result.out, "Falling grains"));
  CHECK(contains(result.out, "pile  200 particles"));
  CHECK(contains(result.out, "grains.repulsion"));
  CHECK(contains(result.out, "neighbour search"));
  CHECK(contains(result.out, "particle-steps per second"));
  CHECK(contains(result.out, "height     exact: 1  max"));
  CHECK(contains(result.out, "pass"));
  const std::string summary = read("results/pile/summary.json");
  for (const char* part : {"\"status\": \"finished\"", "\"verdict\": \"pass\"", "\"nanoseconds_per_pair\"",
                           "\"peak_memory_bytes\"", "\"name\": \"motion\"", "\"id\": \"grains\""})
    CHECK_MESSAGE(contains(summary, part), part);
  CHECK(contains(read("results/pile/case.yaml"), "longest_step: 0.001"));
  CHECK(rows("results/pile/probes/height.csv").size() == 11);
  CHECK(contains(read("results/pile/probes/height.csv"), "time [s],height [m]\n0,"));
  CHECK(rows("results/pile/probes/height.csv")[0][1] == doctest::Approx(1.0).epsilon(1e-14));
  for (const char* name : {"0.txt", "1.txt", "2.txt"})
    CHECK(contains(read(std::filesystem::path("results/pile/grains.tables") / name), " velocity:2\n"));
  CHECK_FALSE(std::filesystem::exists("results/pile/grains.tables/3.txt"));
  CHECK(std::distance(std::filesystem::directory_iterator("results/pile/checkpoints"), {}) == 1);
}

TEST_CASE("an existing folder is not overwritten without --force, and not before the new case is good") {
  std::filesystem::remove_all("kept");
  write("pile.yaml", grains(""));
  REQUIRE(shoal({"run", "pile.yaml", "-o", "kept"}).code == 0);
  write("kept/precious", "x");
  const std::string summary = read("kept/summary.json");
  const Result refused = shoal({"run", "pile.yaml", "-o", "kept"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "--force"));
  CHECK(contains(refused.err, "shoal resume kept"));
  write("broken.yaml", grains("output: [grains.tables: {every: 1 ms, fields: [nonsense]}]\n"));
  CHECK(shoal({"run", "broken.yaml", "-o", "kept", "--force"}).code == 2);
  CHECK(read("kept/summary.json") == summary);
  CHECK(read("kept/precious") == "x");
  CHECK(shoal({"run", "pile.yaml", "-o", "kept", "--force"}).code == 0);
  CHECK_FALSE(std::filesystem::exists("kept/precious"));
  CHECK_FALSE(std::filesystem::exists("kept.replaced-1"));

  std::filesystem::create_directory("foreign");
  write("foreign/thesis.tex", "x");
  const Result foreign = shoal({"run", "pile.yaml", "-o", "foreign", "--force"});
  CHECK(foreign.code == 2);
  CHECK(contains(foreign.err, "something else than results of Shoal"));
  CHECK(read("foreign/thesis.tex") == "x");
}

TEST_CASE("exit code 2 for what is wrong with the case, with its place") {
  write("wrong.yaml", grains("", "bodies: [pile], stifness: 1"));
  const Result key = shoal({"check", "wrong.yaml"});
  CHECK(key.code == 2);
  CHECK(contains(key.err,
                 "wrong.yaml:14:38: error: unknown key 'stifness' in grains.falling; did you mean "
                 "'stiffness'?"));

  write("field.yaml", grains("output:\n  - grains.tables: {every: 1 ms, fields: [velocity, vorticity]}\n"));
  const Result field = shoal({"check", "field.yaml"});
  CHECK(field.code == 2);
  CHECK(contains(field.err, "field.yaml:17:"));
  CHECK(contains(field.err, "has no field 'vorticity'"));
  CHECK(contains(field.err, "'kinetic_energy'"));
  CHECK(contains(field.err, "   17 |   - grains.tables"));

  write("probe.yaml", grains("probes:\n  p: {sum: {of: mass * speed, body: pile}, every: 1 ms}\n"));
  const Result probe = shoal({"check", "probe.yaml"});
  CHECK(probe.code == 2);
  CHECK(contains(probe.err, "probe.yaml:17:"));
  CHECK(contains(probe.err, "'speed'"));

  write("part.yaml", grains("probes:\n  p: {sum: {of: velocity.z, body: pile}, every: 1 ms}\n"));
  const Result part = shoal({"check", "part.yaml"});
  CHECK(part.code == 2);
  CHECK(contains(part.err, "the field 'velocity' has no part 'z' (x, y, magnitude)"));

  write("data.yaml",
        grains("probes:\n  p: {sum: {of: mass, body: pile}, every: 1 ms}\n"
               "reference:\n  - {probe: p, data: data.csv, value_column: weight, tolerance: 1 %}\n"));
  write("data.csv", "time,mass\n0,2000\n");
  const Result data = shoal({"check", "data.yaml"});
  CHECK(data.code == 2);
  CHECK(contains(data.err, "has no column 'weight'; it has time, mass"));

  CHECK(shoal({"run", "nowhere.yaml"}).code == 2);
  CHECK(shoal({"sprint"}).code == 2);
  CHECK(shoal({"run", "wrong.yaml", "--threads", "0"}).code == 2);
  CHECK(shoal({"--help"}).code == 0);
  CHECK(shoal({"run", "--help"}).code == 0);
}

TEST_CASE("exit code 3 when the physics fails, with the worst particles and a dump") {
  write("break.yaml", grains("", "bodies: [pile], breakdown: 20 ms"));
  const Result result = shoal({"run", "break.yaml", "-o", "broken", "--force"});
  CHECK(result.code == 3);
  CHECK(contains(result.err, "the physics failed at"));
  CHECK(contains(result.err, "velocity"));
  CHECK(contains(result.err, "nan"));
  CHECK(contains(result.err, "broken/failure"));
  CHECK(contains(read("broken/summary.json"), "\"status\": \"failed\""));
  const std::string dump = read("broken/failure/pile.csv");
  CHECK(contains(dump, "id,"));
  CHECK(contains(dump, "velocity.x [m/s],velocity.y [m/s]"));
  CHECK(std::count(dump.begin(), dump.end(), '\n') == 201);

  write("break.yaml", grains("output: [grains.tables: {every: 1 s}]\n", "bodies: [pile], breakdown: 20 ms"));
  CHECK(shoal({"run", "break.yaml", "-o", "broken", "--force"}).code == 3);
  CHECK(contains(read("broken/failure/0.txt"), "pile 0.0"));
  CHECK_FALSE(std::filesystem::exists("broken/failure/pile.csv"));
}

TEST_CASE("a reference that is not met is said, and is an error with --strict") {
  write("strict.yaml", grains("probes:\n  height: {mean: {of: position.y, body: pile}, every: 10 ms}\n"
                              "reference:\n  - {probe: height, exact: \"2\", tolerance: 5 %}\n"));
  const Result plain = shoal({"run", "strict.yaml", "-o", "strict", "--force"});
  CHECK(plain.code == 0);
  CHECK(contains(plain.out, "FAIL"));
  CHECK(shoal({"run", "strict.yaml", "-o", "strict", "--force", "--strict"}).code == 3);
  const Result stopped =
      shoal({"run", "strict.yaml", "-o", "strict", "--force", "--strict", "--until", "50 ms"});
  CHECK(stopped.code == 0);
  CHECK(contains(stopped.out, "incomplete"));
}

TEST_CASE("plan shows the tree, memory, and what is not computed") {
  write("pile.yaml", grains(""));
  const Result result = shoal({"plan", "pile.yaml", "--set", "dx=0.05"});
  REQUIRE(result.code == 0);
  for (const char* part :
       {"plugins: grains 1.0.0", "loop motion", "forces  (clears pile.acceleration)",
        "grains.repulsion  on pile with pile", "limits the time step", "pile: 800 particles",
        "bytes per particle", "not computed, since nothing asks for it: grains.kinetic_energy on pile",
        "note: grains of stiffness 50"})
    CHECK_MESSAGE(contains(result.out, part), part);
  CHECK_FALSE(std::filesystem::exists("results/plan"));
  write("energy.yaml", grains("probes:\n  e: {sum: {of: kinetic_energy, body: pile}, every: 1 ms}\n"));
  const Result asked = shoal({"plan", "energy.yaml"});
  CHECK(contains(asked.out, "grains.kinetic_energy  on pile  (on demand)"));
  CHECK_FALSE(contains(asked.out, "not computed"));
}

TEST_CASE("describe, plugins and schema say what there is") {
  const Result all = shoal({"describe"});
  CHECK(all.code == 0);
  for (const char* part : {"half_space", "maximum", "grains, idle", "sections of a case"})
    CHECK_MESSAGE(contains(all.out, part), part);
  const Result type = shoal({"describe", "grains.falling"});
  CHECK(type.code == 0);
  CHECK(contains(type.out, "physics of plugin grains 1.0.0"));
  CHECK(contains(type.out, "longest_step"));
  CHECK(contains(shoal({"describe", "grains"}).out, "grains.matter"));
  CHECK(contains(shoal({"describe", "run"}).out, "checkpoint_every"));
  CHECK(contains(shoal({"describe", "resolution"}).out, "Initial distance of the particles."));
  const Result unknown = shoal({"describe", "maximun"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "did you mean 'maximum'"));
  const Result plugins = shoal({"plugins"});
  CHECK(plugins.code == 0);
  // Columns are as wide as the longest name.
  const std::size_t idle = plugins.out.find("idle ");
  REQUIRE(idle != std::string::npos);
  CHECK(plugins.out.substr(plugins.out.find_first_not_of(' ', idle + 5), 5) == "1.0.0");
  const Result schema = shoal({"schema"});
  CHECK(schema.code == 0);
  CHECK(contains(schema.out, "grains.falling"));
}

TEST_CASE("--json gives one object per line") {
  write("pile.yaml", grains(""));
  const Result result = shoal({"run", "pile.yaml", "-o", "json", "--force", "--json"});
  REQUIRE(result.code == 0);
  std::istringstream lines(result.out);
  std::string line, events;
  while (std::getline(lines, line)) {
    REQUIRE(line.front() == '{');
    REQUIRE(line.back() == '}');
    if (contains(line, "\"event\":\"start\"")) events += "start ";
    if (contains(line, "\"event\":\"end\"")) events += "end";
  }
  CHECK(events == "start end");
  CHECK(result.err.empty());
  const Result wrong = shoal({"check", "nowhere.yaml", "--json"});
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.out, "\"event\":\"error\""));
}

TEST_CASE("only the plugins of the case are mapped") {
  write("long.yaml", grains("", "bodies: [pile]", "1000"));
  Process process({"run", "long.yaml", "-o", "mapped", "--force"});
  const std::string maps = "/proc/" + std::to_string(process.pid()) + "/maps";
  REQUIRE(eventually([&] { return contains(read(maps), "/grains.so"); }));
  REQUIRE(eventually([&] { return std::filesystem::exists("mapped/summary.json"); }));
  std::set<std::string> plugins;
  std::istringstream lines(read(maps));
  for (std::string line; std::getline(lines, line);)
    for (const char* folder : {SHOAL_TEST_PLUGINS "/", SHOAL_PLUGINS_FOLDER "/"})
      if (contains(line, folder)) plugins.insert(line.substr(line.rfind('/') + 1));
  CHECK(plugins == std::set<std::string>{"grains.so"});
}

TEST_CASE("a case may name folders of plugins only with leave") {
  std::filesystem::create_directories("bring");
  std::filesystem::copy_file(SHOAL_TEST_PLUGINS "/idle.so", "bring/brought.so",
                             std::filesystem::copy_options::overwrite_existing);
  std::string text = grains("plugin_paths: bring\n");
  write("paths.yaml", text);
  CHECK(shoal({"check", "paths.yaml"}).code == 0);
  text.replace(text.find("[grains]"), 8, "[grains, brought]");
  write("paths.yaml", text);
  const Result refused = shoal({"check", "paths.yaml"});
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "only with --allow-plugin-paths"));
  CHECK(contains(refused.err, "there is no plugin 'brought'"));
  // Found then, but it is another plugin than its name says.
  const Result allowed = shoal({"check", "paths.yaml", "--allow-plugin-paths"});
  CHECK(allowed.code == 2);
  CHECK_FALSE(contains(allowed.err, "there is no plugin 'brought'"));
  CHECK(contains(allowed.err, "idle"));
}

TEST_CASE("overlapping bodies: the first one keeps its particles") {
  std::string text = grains("");
  text.replace(text.find("physics:"), 0,
               "  lump:\n    shape: {ball: {centre: [2, 1], radius: 0.4}}\n    material: grains.matter\n");
  text.replace(text.find("bodies: [pile]"), 14, "bodies: [pile, lump]");
  write("overlap.yaml", text);
  const Result result = shoal({"check", "overlap.yaml"});
  CHECK(result.code == 0);
  CHECK(contains(result.err, "'lump' overlaps 'pile', which comes first"));
  text.replace(text.find("[2, 1], radius: 0.4"), 19, "[1, 1], radius: 0.4");
  write("overlap.yaml", text);
  const Result hidden = shoal({"check", "overlap.yaml"});
  CHECK(hidden.code == 2);
  CHECK(contains(hidden.err, "no particle of it is left"));
}
