// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// kill -9 again and again, while tables, checkpoints and probes are written: what is there stays readable, and the run
// that goes on each time ends as the one that was never killed.
#include <random>

#include "tests/app/support.hpp"

using namespace app_test;

namespace {

// Files that a reader may find at any moment are whole.
void check_readable(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/grains.tables")) {
    if (entry.path().extension() != ".txt") continue;
    const std::string text = read(entry.path());
    REQUIRE(text.size() > 4);
    CHECK(text.substr(text.size() - 4) == "end\n");
  }
  const std::string summary = read(folder + "/summary.json");
  CHECK(summary.front() == '{');
  CHECK(summary.substr(summary.size() - 2) == "}\n");
}

std::size_t n_checkpoints(const std::string& folder) {
  std::size_t n = 0;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/checkpoints", none))
    n += entry.path().extension() == ".checkpoint" ? 1 : 0;
  return n;
}

}  // namespace

TEST_CASE("killed while it writes, a run can always go on and ends the same") {
  const std::string text = grains(
      "probes:\n  height: {mean: {of: position.y, body: pile}, every: 1 ms}\n"
      "output:\n  - grains.tables: {every: 4 ms, pause: 5 ms}\n",
      "bodies: [pile], damping: 0.5", "0.4, checkpoint_every: 3 ms");
  write("pile.yaml", text);
  REQUIRE(shoal({"run", "pile.yaml", "-o", "whole", "--force"}).code == 0);
  std::filesystem::remove_all("killed");
  std::mt19937 random(20240229);
  // From before the first file to well into the run, wherever the machine is slow or fast: outputs alone pause for 0.5 s.
  std::uniform_int_distribution<int> milliseconds(5, 100);
  int kills = 0;
  bool finished = false;
  for (int k = 0; k < 40 && !finished; ++k) {
    const bool resumable = n_checkpoints("killed") > 0;
    Process process(resumable ? std::vector<std::string>{"resume", "killed"}
                              : std::vector<std::string>{"run", "pile.yaml", "-o", "killed", "--force"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random)));
    if (process.running()) process.send(SIGKILL);
    const int code = process.wait();  // 0 if it came to its end, perhaps just before the signal
    finished = code == 0;
    kills += code == -SIGKILL ? 1 : 0;
    INFO(read("err"));
    CHECK((finished || code == -SIGKILL));
    if (!resumable && n_checkpoints("killed") == 0) continue;
    // Each kill just before the oldest one goes leaves one more.
    CHECK(n_checkpoints("killed") <= 2 + kills);
    check_readable("killed");
  }
  CHECK(kills >= 3);
  if (!finished) {
    const Result result = shoal({"resume", "killed"});
    INFO(result.err);
    REQUIRE(result.code == 0);
  }
  CHECK(n_checkpoints("killed") == 2);
  CHECK(read("killed/probes/height.csv") == read("whole/probes/height.csv"));
  for (const auto& entry : std::filesystem::directory_iterator("whole/grains.tables"))
    CHECK(read(entry.path()) == read("killed/grains.tables/" + entry.path().filename().string()));
}

TEST_CASE("results that --force replaces are there until the new run has begun") {
  write("pile.yaml", grains("", "bodies: [pile]", "1000"));
  std::filesystem::remove_all("replaced");
  REQUIRE(shoal({"run", "pile.yaml", "-o", "replaced", "--until", "0.01"}).code == 0);
  std::mt19937 random(7);
  std::uniform_int_distribution<int> milliseconds(0, 80);
  for (int k = 0; k < 15; ++k) {
    Process process({"run", "pile.yaml", "-o", "replaced", "--force"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random)));
    process.send(SIGKILL);
    process.wait();
    // The old results, or the new ones, or the old ones aside: never neither.
    bool there = std::filesystem::exists("replaced/summary.json");
    for (const auto& entry : std::filesystem::directory_iterator("."))
      there = there || (contains(entry.path().string(), "replaced.replaced-") &&
                        std::filesystem::exists(entry.path() / "summary.json"));
    CHECK(there);
  }
  for (const auto& entry : std::filesystem::directory_iterator("."))
    if (contains(entry.path().string(), "replaced.replaced-")) std::filesystem::remove_all(entry.path());
}
