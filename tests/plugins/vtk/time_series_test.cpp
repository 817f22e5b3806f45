// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The list of pictures: its text, and what remains of it and of the folder after a restart.
#include "time_series.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "pictures.hpp"
#include "sample.hpp"

using namespace shoal::vtk;
using namespace shoal::vtk::test;

namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string list(const std::string& entries) {
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "  <Collection>\n" +
         entries + "  </Collection>\n</VTKFile>\n";
}

std::string entry(const std::string& time, const std::string& file) {
  return "    <DataSet timestep=\"" + time + "\" part=\"0\" file=\"" + file + "\"/>\n";
}

// Pictures first ... last - 1 of two bodies, 0.1 s apart.
void run(const std::filesystem::path& folder, std::uint64_t first, std::uint64_t last, int dimensions = 2) {
  const Body water = sample_body("water", dimensions, 20), wall = sample_body("water_2", dimensions, 5);
  const std::vector bodies{water.c(), wall.c()};
  Pictures pictures(folder, first, Precision::single, Compression::fast);
  for (std::uint64_t k = first; k < last; ++k)
    pictures.write(snapshot_of(bodies, dimensions, 0.1 * static_cast<double>(k), k));
}

}  // namespace

TEST_CASE("file names have at least five digits") {
  CHECK(picture_name("water", 0) == "water_00000.vtp");
  CHECK(picture_name("water", 12345) == "water_12345.vtp");
  CHECK(picture_name("water", 1234567) == "water_1234567.vtp");
}

TEST_CASE("a run leaves a list and its pictures for each body, and nothing else") {
  const auto folder = scratch("series");
  run(folder, 0, 4);
  CHECK(files_in(folder) == std::vector<std::string>{"water.pvd", "water_00000.vtp", "water_00001.vtp",
                                                     "water_00002.vtp", "water_00003.vtp", "water_2.pvd",
                                                     "water_2_00000.vtp", "water_2_00001.vtp",
                                                     "water_2_00002.vtp", "water_2_00003.vtp"});
  CHECK(text_of(folder / "water.pvd") ==
        list(entry("0", "water_00000.vtp") + entry("0.1", "water_00001.vtp") +
             entry("0.2", "water_00002.vtp") + entry("0.30000000000000004", "water_00003.vtp")));
}

TEST_CASE("after a restart earlier pictures are kept and later ones forgotten") {
  const auto folder = scratch("resume");
  run(folder, 0, 6);
  const std::string earlier = text_of(folder / "water_00002.vtp");
  {
    // Nothing changes before the first picture of the new run.
    const auto before = files_in(folder);
    Pictures pictures(folder, 3, Precision::single, Compression::fast);
    CHECK(files_in(folder) == before);
  }
  run(folder, 3, 4);
  CHECK(files_in(folder) == std::vector<std::string>{"water.pvd", "water_00000.vtp", "water_00001.vtp",
                                                     "water_00002.vtp", "water_00003.vtp", "water_2.pvd",
                                                     "water_2_00000.vtp", "water_2_00001.vtp",
                                                     "water_2_00002.vtp", "water_2_00003.vtp"});
  CHECK(text_of(folder / "water.pvd") ==
        list(entry("0", "water_00000.vtp") + entry("0.1", "water_00001.vtp") +
             entry("0.2", "water_00002.vtp") + entry("0.30000000000000004", "water_00003.vtp")));
  CHECK(text_of(folder / "water_00002.vtp") == earlier);
}

TEST_CASE("a resumed run ends with the same files as one that was not stopped") {
  const auto whole = scratch("whole"), stopped = scratch("stopped");
  run(whole, 0, 5);
  run(stopped, 0, 4);
  run(stopped, 2, 5);
  REQUIRE(files_in(whole) == files_in(stopped));
  for (const std::string& file : files_in(whole)) CHECK(text_of(whole / file) == text_of(stopped / file));
}

TEST_CASE("pictures that were removed by hand are not listed after a restart") {
  const auto folder = scratch("removed");
  run(folder, 0, 3);
  std::filesystem::remove(folder / "water_00001.vtp");
  run(folder, 3, 4);
  CHECK(text_of(folder / "water.pvd") ==
        list(entry("0", "water_00000.vtp") + entry("0.2", "water_00002.vtp") +
             entry("0.30000000000000004", "water_00003.vtp")));
}

TEST_CASE("a new run in an old folder starts a new list and leaves the files of others alone") {
  const auto folder = scratch("anew");
  run(folder, 0, 4);
  for (const char* other :
       {"water.txt", "water_00007.csv", "water_a0001.vtp", "water_001.vtp", "waters_00009.vtp"})
    std::ofstream(folder / other) << "mine";
  run(folder, 0, 1);
  CHECK(files_in(folder) == std::vector<std::string>{"water.pvd", "water.txt", "water_00000.vtp",
                                                     "water_00007.csv", "water_001.vtp", "water_2.pvd",
                                                     "water_2_00000.vtp", "water_a0001.vtp",
                                                     "waters_00009.vtp"});
  CHECK(text_of(folder / "water.pvd") == list(entry("0", "water_00000.vtp")));
}

TEST_CASE("writing a picture again replaces its entry") {
  const auto folder = scratch("again");
  TimeSeries series(folder, "water", 0);
  series.add(0, 0);
  series.add(1, 0.5);
  series.add(1, 0.25);
  CHECK(text_of(folder / "water.pvd") ==
        list(entry("0", "water_00000.vtp") + entry("0.25", "water_00001.vtp")));
}

TEST_CASE("names of bodies survive XML") {
  const auto folder = scratch("names");
  const std::string name = "a & b <\"Wässerle\">";
  const Body body = sample_body(name, 2, 3);
  const std::vector bodies{body.c()};
  Pictures(folder, 0, Precision::single, Compression::fast).write(snapshot_of(bodies, 2, 0, 0));
  Pictures(folder, 1, Precision::single, Compression::fast).write(snapshot_of(bodies, 2, 1, 1));
  CHECK(text_of(folder / (name + ".pvd")) ==
        list(entry("0", "a &amp; b &lt;&quot;Wässerle&quot;&gt;_00000.vtp") +
             entry("1", "a &amp; b &lt;&quot;Wässerle&quot;&gt;_00001.vtp")));
  CHECK(read_picture(folder / (name + "_00001.vtp")) != nullptr);
}

TEST_CASE("a list that cannot be understood is not overwritten") {
  const auto folder = scratch("broken");
  run(folder, 0, 3);
  for (const char* broken : {"", "<?xml version=\"1.0\"?>\n<VTKFile>\n  <Coll", "<html/>"}) {
    std::ofstream(folder / "water.pvd") << broken;
    CHECK_THROWS_WITH_AS(run(folder, 3, 4),
                         ("cannot continue the list of pictures '" + (folder / "water.pvd").string() +
                          "', since it is not a PVD file; move it away to start a new one")
                             .c_str(),
                         std::runtime_error);
    CHECK(text_of(folder / "water.pvd") == broken);
  }
}

TEST_CASE("names that cannot be files are refused") {
  for (const char* name : {"", ".hidden", "a/b"}) {
    const Body body = sample_body(name, 2, 3);
    const std::vector bodies{body.c()};
    Pictures pictures(scratch("unnameable"), 0, Precision::single, Compression::fast);
    CHECK_THROWS_AS(pictures.write(snapshot_of(bodies, 2, 0, 0)), std::invalid_argument);
  }
}
