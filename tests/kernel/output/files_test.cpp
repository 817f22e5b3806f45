// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that must be whole, tables that grow, folders that must not be lost.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "kernel/output/atomic_file.hpp"
#include "kernel/output/checkpoint_store.hpp"
#include "kernel/output/result_folder.hpp"
#include "kernel/output/series_file.hpp"
#include "kernel/particles/errors.hpp"

using namespace shoal::kernel;
namespace fs = std::filesystem;

namespace {

fs::path fresh_folder(const std::string& name) {
  fs::remove_all(name);
  fs::create_directories(name);
  return name;
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string checkpoint(const CheckpointStore& store, std::size_t k, std::string* header = nullptr) {
  std::string body;
  CheckpointStore::read(store.newest_first().at(k), [&](const std::string& head, std::istream& stream) {
    if (header != nullptr) *header = head;
    std::getline(stream, body);
  });
  return body;
}

}  // namespace

TEST_CASE("a file that is not committed leaves the previous one and nothing else") {
  const fs::path folder = fresh_folder("atomic");
  write_atomically(folder / "a", "old");
  {
    AtomicFile file(folder / "a");
    file.stream() << "half of the n";
  }
  CHECK(read_whole_file(folder / "a") == "old");
  CHECK(std::distance(fs::directory_iterator(folder), {}) == 1);
  AtomicFile file(folder / "a");
  file.stream() << "new";
  CHECK(read_whole_file(folder / "a") == "old");
  file.commit();
  CHECK(read_whole_file(folder / "a") == "new");
  CHECK(std::distance(fs::directory_iterator(folder), {}) == 1);
  CHECK_THROWS_WITH_AS(write_atomically(folder / "no" / "b", "x"), doctest::Contains("cannot write"),
                       OutputError);
  CHECK_THROWS_WITH_AS(read_whole_file(folder / "b"), doctest::Contains("No such file"), OutputError);
  CHECK_THROWS_AS(read_whole_file(folder), OutputError);
}

TEST_CASE("a full disk is an error, not a short file") {
  AtomicFile file("atomic_full");
  file.stream().setstate(std::ios::badbit);  // what a failed write leaves
  CHECK_THROWS_AS(file.commit(), OutputError);
  CHECK_FALSE(fs::exists("atomic_full"));
}

TEST_CASE("tables of probes: every digit, units, and going on at a byte") {
  const fs::path folder = fresh_folder("series");
  const std::vector<Column> columns{{"front", "m"}, {"max(a, b)", ""}, {"ratio", "1"}};
  std::uint64_t bytes = 0;
  {
    SeriesFile file(folder / "p.csv", columns);
    file.append(0.1, {1.0 / 3.0, -0.0, 5e-324});
    bytes = file.bytes();
    file.append(0.2, {std::nan(""), -std::nan(""), std::numeric_limits<double>::infinity()});
  }
  CHECK(read_whole_file(folder / "p.csv") ==
        "time [s],front [m],\"max(a, b)\",ratio\n0.1,0.3333333333333333,-0,5e-324\n0.2,nan,nan,inf\n");
  {
    SeriesFile file(folder / "p.csv", columns, bytes);
    CHECK(file.bytes() == bytes);
    file.append(0.3, {1, 2, 3});
    file.sync();
  }
  CHECK(read_whole_file(folder / "p.csv") ==
        "time [s],front [m],\"max(a, b)\",ratio\n0.1,0.3333333333333333,-0,5e-324\n0.3,1,2,3\n");
  const Table table = read_table(folder / "p.csv");
  CHECK(table.names == std::vector<std::string>{"time [s]", "front [m]", "max(a, b)", "ratio"});
  CHECK(table.rows == std::vector<std::vector<double>>{{0.1, 1.0 / 3.0, -0.0, 5e-324}, {0.3, 1, 2, 3}});
  CHECK_THROWS_WITH_AS(SeriesFile(folder / "p.csv", columns, 1000), doctest::Contains("shorter"),
                       OutputError);
  CHECK_THROWS_WITH_AS(SeriesFile(folder / "p.csv", {{"front", "mm"}}, bytes), doctest::Contains("columns"),
                       OutputError);
}

TEST_CASE("tables of others: comments, separators, names, holes") {
  fresh_folder("tables");
  write("tables/a", "# measured 1952\n\n t ; x \n0;1\n 1 ; 2.5e1 \r\n+2;\n");
  const Table a = read_table("tables/a");
  CHECK(a.names == std::vector<std::string>{"t", "x"});
  REQUIRE(a.rows.size() == 3);
  CHECK(a.rows[1] == std::vector<double>{1, 25});
  CHECK(std::isnan(a.rows[2][1]));
  write("tables/b", "0  1\t2\n3 4 5  \n");
  CHECK(read_table("tables/b").rows == std::vector<std::vector<double>>{{0, 1, 2}, {3, 4, 5}});
  write("tables/c", "t,x\n0,1\n1\n");
  CHECK_THROWS_WITH_AS(read_table("tables/c"), "tables/c:3: 1 columns where 2 were expected", OutputError);
  write("tables/d", "t,x\n0,1\n1,two\n");
  CHECK_THROWS_WITH_AS(read_table("tables/d"), "tables/d:3: 'two' is no number", OutputError);
  write("tables/e", "t,x\n");
  CHECK_THROWS_WITH_AS(read_table("tables/e"), "'tables/e' holds no numbers", OutputError);
}

TEST_CASE("the last two checkpoints are kept, newest first") {
  const fs::path folder = fresh_folder("checkpoints");
  CheckpointStore store(folder / "c");
  CHECK(store.newest_first().empty());
  for (const std::uint64_t step : {9u, 10u, 100u, 99999u})
    store.write(step, "head of " + std::to_string(step),
                [&](std::ostream& body) { body << "body of " << step; });
  REQUIRE(store.newest_first().size() == 2);
  std::string header;
  CHECK(checkpoint(store, 0, &header) == "body of 99999");
  CHECK(header == "head of 99999");
  CHECK(checkpoint(store, 1) == "body of 100");

  // A kill while the next one is written leaves a part that nobody takes for a checkpoint.
  write(folder / "c" / "step_00000000000000100000.checkpoint.part", "shoal check");
  CHECK(checkpoint(store, 0) == "body of 99999");
  CHECK_THROWS(store.write(100000, "", [](std::ostream&) { throw CheckpointError("no"); }));
  CHECK(checkpoint(store, 0) == "body of 99999");
  store.remove_newer_than(store.newest_first()[1]);
  CHECK(checkpoint(store, 0) == "body of 100");
}

TEST_CASE("damage to the head of a checkpoint is found") {
  const fs::path folder = fresh_folder("damage");
  CheckpointStore store(folder);
  const fs::path path = store.write(1, "a header of some length", [](std::ostream& body) { body << "body"; });
  const std::string good = read_whole_file(path);
  const auto read = [&] { CheckpointStore::read(path, [](const std::string&, std::istream&) {}); };
  CHECK_NOTHROW(read());
  const std::size_t head = good.size() - 4;
  for (std::size_t byte = 0; byte < head; ++byte) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ 0x10);
    write(path, bad);
    CHECK_THROWS_AS(read(), CheckpointError);
    write(path, good.substr(0, byte));
    CHECK_THROWS_AS(read(), CheckpointError);
  }
}

TEST_CASE("folders of results: never two runs, never lost by mistake") {
  fresh_folder("folders");
  const fs::path folder = "folders/a";
  {
    ResultFolder made = ResultFolder::make("folders/a/", false);
    CHECK(made.path() == folder);
    CHECK_THROWS_WITH_AS(ResultFolder::check_free(folder, true), doctest::Contains("another run"),
                         FolderError);
    made.write_case("shoal: 1\n");
    made.write_summary("{}\n");
  }
  CHECK_THROWS_WITH_AS(ResultFolder::check_free(folder, false), doctest::Contains("--force"), FolderError);
  {
    ResultFolder again = ResultFolder::make(folder, true);
    CHECK(read_whole_file("folders/a.replaced-1/summary.json") == "{}\n");
    again.write_case("shoal: 1\n");
    again.write_summary("{new}\n");
    again.remove_replaced();
    CHECK_FALSE(fs::exists("folders/a.replaced-1"));
  }
  CHECK(ResultFolder::reopen(folder / ".").path() == folder);
  CHECK(read_whole_file(folder / "summary.json") == "{new}\n");
  CHECK_THROWS_AS(ResultFolder::reopen("folders/none"), FolderError);
  CHECK_THROWS_WITH_AS(ResultFolder::reopen("folders"), doctest::Contains("no case.yaml"), FolderError);

  fs::remove(folder / ".shoal");  // as after a copy without hidden files
  CHECK_THROWS_WITH_AS(ResultFolder::check_free(folder, false), doctest::Contains("--force"), FolderError);
  CHECK_NOTHROW(ResultFolder::check_free(folder, true));
  write(folder / ".shoal", "");

  // A run that was killed before its first results left nothing that is worth asking for.
  fs::remove(folder / "summary.json");
  CHECK_NOTHROW(ResultFolder::check_free(folder, false));
  fs::create_directory("folders/empty");
  CHECK_NOTHROW(ResultFolder::check_free("folders/empty", false));
  write("folders/file", "x");
  CHECK_THROWS_AS(ResultFolder::check_free("folders/file", true), FolderError);
  fs::create_directory("folders/home");
  write("folders/home/case.yaml", "x");
  CHECK_THROWS_WITH_AS(ResultFolder::make("folders/home", true), doctest::Contains("something else"),
                       FolderError);
}
