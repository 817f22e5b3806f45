// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A run that was stopped, interrupted or damaged and went on equals the one that was never stopped.
#include "tests/app/support.hpp"

using namespace app_test;

namespace {

const std::string sections =
    "probes:\n"
    "  height: {mean: {of: position.y, body: pile}, every: 3 ms}\n"
    "  energy: {sum: {of: kinetic_energy, body: pile}, every: 5 ms}\n"
    "output:\n"
    "  - grains.tables: {every: 10 ms}\n";

std::vector<std::filesystem::path> checkpoints(const std::string& folder) {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/checkpoints"))
    all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

// The particles in the last checkpoint; before them stand wall times and counts of lists that were built.
std::string last_state(const std::string& folder) {
  const std::string text = read(checkpoints(folder).back());
  std::uint64_t header = 0;
  std::memcpy(&header, text.data() + 24, sizeof header);
  const std::string state = text.substr(40 + header);
  const std::size_t first_body = state.find(std::string("body\0", 5));
  REQUIRE(first_body != std::string::npos);
  return state.substr(first_body);
}

void check_same(const std::string& a, const std::string& b) {
  for (const char* probe : {"height", "energy"})
    CHECK(read(a + "/probes/" + probe + ".csv") == read(b + "/probes/" + probe + ".csv"));
  for (const auto& entry : std::filesystem::directory_iterator(a + "/grains.tables"))
    CHECK(read(entry.path()) == read(b + "/grains.tables/" + entry.path().filename().string()));
  CHECK(std::distance(std::filesystem::directory_iterator(a + "/grains.tables"), {}) ==
        std::distance(std::filesystem::directory_iterator(b + "/grains.tables"), {}));
  CHECK(last_state(a) == last_state(b));
}

void run_whole() {
  static bool done = false;
  if (done) return;
  write("pile.yaml", grains(sections, "bodies: [pile], damping: 0.5", "0.5"));
  REQUIRE(shoal({"run", "pile.yaml", "-o", "whole", "--force"}).code == 0);
  done = true;
}

}  // namespace

TEST_CASE("stopped twice, by time and by steps, and resumed: bitwise the same") {
  run_whole();
  REQUIRE(shoal({"run", "pile.yaml", "-o", "parts", "--force", "--until", "0.123"}).code == 0);
  CHECK(contains(read("parts/summary.json"), "\"status\": \"stopped\""));
  REQUIRE(shoal({"resume", "parts", "--steps", "77"}).code == 0);
  REQUIRE(shoal({"resume", "parts"}).code == 0);
  check_same("whole", "parts");
  CHECK(contains(read("parts/summary.json"), "\"status\": \"finished\""));
  // What is finished has nothing left to do.
  CHECK(shoal({"resume", "parts"}).code == 0);
  check_same("whole", "parts");
}

TEST_CASE("the same on one thread and on two") {
  run_whole();
  REQUIRE(shoal({"run", "pile.yaml", "-o", "one", "--force", "--threads", "1"}).code == 0);
  REQUIRE(shoal({"run", "pile.yaml", "-o", "two", "--force", "--threads", "2"}).code == 0);
  check_same("one", "two");
}

TEST_CASE("a signal lets the step finish, writes a checkpoint and says how to go on") {
  run_whole();
  for (const int signal : {SIGINT, SIGTERM}) {
    write("long.yaml", grains(sections, "bodies: [pile], damping: 0.5", "1000"));
    std::filesystem::remove_all("signal");
    Process process({"run", "long.yaml", "-o", "signal"});
    REQUIRE(eventually([] { return std::filesystem::exists("signal/grains.tables/3.txt"); }));
    process.send(signal);
    CHECK(process.wait() == 130);
    CHECK(contains(read("out"), "interrupted at"));
    CHECK(contains(read("out"), "shoal resume signal"));
    CHECK(contains(read("signal/summary.json"), "\"status\": \"interrupted\""));
    // Until where the whole run ends, if it is not there already.
    const double reached = rows("signal/probes/height.csv").back()[0];
    if (reached > 0.45) continue;
    REQUIRE(shoal({"resume", "signal", "--until", "0.495"}).code == 0);
    const std::string whole = read("whole/probes/height.csv"), part = read("signal/probes/height.csv");
    CHECK(whole.substr(0, part.size()) == part);
  }
}

TEST_CASE("a damaged checkpoint is passed over for the one before it") {
  run_whole();
  write("often.yaml", grains(sections, "bodies: [pile], damping: 0.5", "0.5, checkpoint_every: 50 ms"));
  REQUIRE(shoal({"run", "often.yaml", "-o", "damaged", "--force", "--until", "0.26"}).code == 0);
  const auto files = checkpoints("damaged");
  REQUIRE(files.size() == 2);
  std::string text = read(files[1]);
  SUBCASE("cut") { write(files[1], text.substr(0, text.size() / 2)); }
  SUBCASE("a flipped bit in the state") {
    text[text.size() - 1000] = static_cast<char>(text[text.size() - 1000] ^ 4);
    write(files[1], text);
  }
  SUBCASE("a flipped bit in the head") {
    text[100] = static_cast<char>(text[100] ^ 4);
    write(files[1], text);
  }
  SUBCASE("empty") { write(files[1], ""); }
  const Result result = shoal({"resume", "damaged"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(contains(result.err, "trying the one before"));
  check_same("whole", "damaged");
}

TEST_CASE("no checkpoint that can be read is an error of the program, none at all of the user") {
  run_whole();
  std::filesystem::remove_all("none");
  std::filesystem::copy("whole", "none", std::filesystem::copy_options::recursive);
  for (const auto& file : checkpoints("none")) write(file, "shoal");
  CHECK(shoal({"resume", "none"}).code == 1);
  std::filesystem::remove_all("none/checkpoints");
  const Result result = shoal({"resume", "none"});
  CHECK(result.code == 2);
  CHECK(contains(result.err, "no checkpoint to go on from"));
  CHECK(shoal({"resume", "nowhere"}).code == 2);
}

TEST_CASE("a case that is another computation now is refused, with what differs") {
  run_whole();
  REQUIRE(shoal({"run", "pile.yaml", "-o", "changed", "--force", "--until", "0.1"}).code == 0);
  const Result result = shoal({"resume", "changed", "--set", "physics.grains.falling.stiffness=60"});
  CHECK(result.code == 2);
  CHECK(contains(result.err, "stiffness: 50 -> 60"));
  CHECK(contains(result.err, "--force"));
  const Result forced =
      shoal({"resume", "changed", "--set", "physics.grains.falling.stiffness=60", "--force"});
  CHECK(forced.code == 0);
  CHECK(contains(forced.err, "changed since the checkpoint"));
  CHECK(contains(read("changed/case.yaml"), "stiffness: 60"));
}

TEST_CASE("the end may move, and the effective case keeps saying where values came from") {
  run_whole();
  REQUIRE(shoal({"run", "pile.yaml", "-o", "longer", "--force", "--set", "run.end=0.2"}).code == 0);
  const std::string effective = read("longer/case.yaml");
  REQUIRE(shoal({"resume", "longer"}).code == 0);
  CHECK(read("longer/case.yaml") == effective);
  REQUIRE(shoal({"resume", "longer", "--set", "run.end=0.3"}).code == 0);
  CHECK(rows("longer/probes/height.csv").back()[0] == doctest::Approx(0.3).epsilon(1e-3));
}
