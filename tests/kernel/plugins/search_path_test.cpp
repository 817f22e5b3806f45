// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where plugins are looked for. Nothing is loaded here, so empty files serve.
#include "kernel/plugins/search_path.hpp"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <fstream>

#include "kernel/plugins/loader.hpp"

using namespace shoal::kernel;
namespace fs = std::filesystem;

namespace {

fs::path folder_with(const std::string& name, const std::vector<std::string>& files) {
  const fs::path folder = fs::current_path() / "search" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const std::string& file : files) std::ofstream(folder / file).flush();
  return folder;
}

std::vector<std::string> origins(const SearchPath& search_path) {
  std::vector<std::string> list;
  for (const auto& place : search_path.places()) list.push_back(place.origin);
  return list;
}

}  // namespace

TEST_CASE("the order is command line, case, environment, build tree, installation") {
  const fs::path program = folder_with("tree/bin", {}).parent_path() / "bin";
  const fs::path built = folder_with("tree/plugins", {"five.so", "six.so"});
  const fs::path installed = folder_with("tree/lib/shoal/plugins/abi-1", {"six.so"});
  const fs::path line = folder_with("line", {"one.so", "two.so"});
  const fs::path of_case = folder_with("case", {"one.so", "two.so", "three.so"});
  const fs::path environment = folder_with("environment", {"three.so", "four.so", "five.so"});
  SearchSettings settings{{line}, {of_case}, true, environment.string(), program};

  const SearchPath all(settings);
  CHECK(origins(all) == std::vector<std::string>{"--plugin-path", "the case", "SHOAL_PLUGIN_PATH",
                                                 "build tree", "installation"});
  CHECK(all.find("one") == line / "one.so");
  CHECK(all.find("three") == of_case / "three.so");
  CHECK(all.find("four") == environment / "four.so");
  CHECK(all.find("five") == environment / "five.so");
  CHECK(all.find("six") == built / "six.so");
  CHECK(all.available() == std::vector<std::string>{"five", "four", "one", "six", "three", "two"});
  CHECK(all.files().size() == 11);

  settings.allow_plugin_paths = false;
  const SearchPath careful(settings);
  CHECK(careful.find("three") == environment / "three.so");
  CHECK(careful.description()[1] ==
        of_case.string() +
            " (the case; not searched: a case may name folders only with --allow-plugin-paths)");
  // A folder that the user names too may be searched.
  settings.environment += ":" + of_case.string();
  CHECK(SearchPath(settings).find("two") == line / "two.so");
  settings.command_line.clear();
  CHECK(SearchPath(settings).find("two") == of_case / "two.so");
}

TEST_CASE("folders that are missing, repeated or empty") {
  const fs::path here = folder_with("here", {"one.so"});
  SearchSettings settings;
  settings.command_line = {here, here / "nothing", here / "." / ".." / "here"};
  settings.environment = ":" + here.string() + "::";
  const SearchPath search_path(settings);
  CHECK(search_path.description() ==
        std::vector<std::string>{here.string() + " (--plugin-path)",
                                 (here / "nothing").string() + " (--plugin-path; no such folder)"});
  CHECK_FALSE(search_path.find("two"));
  settings.command_line.clear();
  settings.environment = ":";  // not the current folder
  CHECK(SearchPath(settings).places().empty());
}

TEST_CASE("only names that can be ids count as plugins") {
  const fs::path here = folder_with("names", {"fluid.so", "libfluid.so.1", "README.md", "Fluid.so", "2d.so",
                                              "my-own.so", "libm.a", "a_b2.so"});
  SearchSettings settings;
  settings.command_line = {here};
  CHECK(SearchPath(settings).available() == std::vector<std::string>{"a_b2", "fluid"});
  CHECK(is_snake_case("a_b2"));
  for (const char* text : {"", "A", "2d", "_a", "a-b", "a.b", "../a", "a b", "\xc3\xa4"})
    CHECK_FALSE(is_snake_case(text));
}

TEST_CASE("a plugin that is nowhere: places searched, and what is there") {
  const fs::path here = folder_with("nowhere", {"fluid.so", "vtk.so"});
  SearchSettings settings;
  settings.command_line = {here, here / "missing"};
  Loader loader(settings);
  try {
    loader.load("flud");
    FAIL("found");
  } catch (const LoadFailure& failure) {
    CHECK(failure.problem() == LoadProblem::not_found);
    CHECK(std::string(failure.what()) == "there is no plugin 'flud'");
    CHECK(failure.notes() == std::vector<std::string>{"searched: " + here.string() + " (--plugin-path)",
                                                      "searched: " + (here / "missing").string() +
                                                          " (--plugin-path; no such folder)",
                                                      "plugins there: fluid, vtk"});
    CHECK(failure.available() == std::vector<std::string>{"fluid", "vtk"});
  }
}

TEST_CASE("an id is a word, never a path") {
  Loader loader(SearchSettings{});
  for (const char* id : {"../fluid", "/tmp/fluid", "fluid.so", ""}) {
    try {
      loader.load(id);
      FAIL("loaded");
    } catch (const LoadFailure& failure) {
      CHECK(failure.problem() == LoadProblem::bad_id);
      CHECK(failure.what() == "'" + std::string(id) + "' cannot be the name of a plugin");
      CHECK(failure.notes().size() == 1);
    }
  }
}

TEST_CASE("settings of this process: environment and the program's own folder") {
  ::setenv("SHOAL_PLUGIN_PATH", "/a:/b", 1);
  const SearchSettings settings = SearchSettings::of_this_process();
  ::unsetenv("SHOAL_PLUGIN_PATH");
  CHECK(settings.environment == "/a:/b");
  CHECK(settings.program_folder == fs::read_symlink("/proc/self/exe").parent_path());
  CHECK(SearchSettings::of_this_process().environment.empty());
}
