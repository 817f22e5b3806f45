// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plugin that nobody asks for costs nothing: it is not even opened. Seen from the operating system's side.
#include <doctest/doctest.h>

#include <fstream>
#include <set>
#include <string>

#include "kernel/plugins/loader.hpp"

using namespace shoal::kernel;

namespace {

// Names of the files of the test's plugin folder that are mapped into this process.
std::set<std::string> mapped_plugins() {
  const std::string folder = SHOAL_TEST_PLUGINS "/";
  std::set<std::string> names;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const auto at = line.find(folder); at != std::string::npos)
      names.insert(line.substr(at + folder.size()));
  return names;
}

}  // namespace

TEST_CASE("only requested plugins, and those that they require, are opened") {
  SearchSettings settings;
  settings.command_line = {SHOAL_TEST_PLUGINS};
  CHECK(mapped_plugins().empty());
  {
    Loader loader(settings);
    CHECK(loader.search_path().available().size() > 20);
    CHECK_THROWS_AS(loader.load("nowhere"), LoadFailure);      // suggestions need names alone
    CHECK_THROWS_AS(loader.load("newer_major"), LoadFailure);  // refused by its stamp
    CHECK(mapped_plugins().empty());
    loader.load("good");
    CHECK(mapped_plugins() == std::set<std::string>{"good.so"});
    loader.load("on_good");
    CHECK(mapped_plugins() == std::set<std::string>{"good.so", "on_good.so"});
  }
  // Never unloaded: types and texts of a plugin live as long as the process.
  CHECK(mapped_plugins() == std::set<std::string>{"good.so", "on_good.so"});
}
