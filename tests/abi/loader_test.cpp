// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The loader against plugins that are broken in every way that we could think of: each has its own sentence, which
// is checked as a user reads it.
#include "kernel/plugins/loader.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace shoal::kernel;
namespace fs = std::filesystem;

namespace {

const fs::path folder = SHOAL_TEST_PLUGINS;

SearchSettings in(const fs::path& place) {
  SearchSettings settings;
  settings.command_line = {place};
  return settings;
}

LoadFailure failure_of(const std::string& id, const VersionRange& versions = {},
                       const fs::path& place = folder) {
  Loader loader(in(place));
  try {
    loader.load(id, versions);
  } catch (const LoadFailure& failure) {
    CHECK(loader.is_loaded(id) == (failure.problem() == LoadProblem::version && failure.id() == id));
    return failure;
  }
  FAIL("plugin '" << id << "' was loaded");
  throw;
}

// The sentence with the plugin's name and path taken off its beginning, after checking that they are there.
std::string said(const LoadFailure& failure) {
  const std::string begin =
      "plugin '" + failure.id() + "' (" + (folder / (failure.id() + ".so")).string() + ") ";
  const std::string text = failure.what();
  CHECK_MESSAGE(text.starts_with(begin), text);
  return text.substr(std::min(begin.size(), text.size()));
}

fs::path scratch(const std::string& name) {
  const fs::path path = fs::current_path() / name;
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

}  // namespace

TEST_CASE("a sound plugin is loaded and describes itself") {
  Loader loader(in(folder));
  const LoadedPlugin& plugin = loader.load("good", {"1.0", "2"});
  CHECK(plugin.id == "good");
  CHECK(plugin.version_text == "1.0.0");
  CHECK(plugin.licence == "Apache-2.0");
  CHECK(plugin.summary == "A plugin of the tests.");
  CHECK(plugin.path == folder / "good.so");
  CHECK(std::string(plugin.stamp.compiler) == "test compiler 1");
  REQUIRE(plugin.types.size() == 1);
  CHECK(std::string(plugin.types[0]->name) == "good.type");
  CHECK(&loader.load("good") == &plugin);
  CHECK(loader.loaded().size() == 1);
}

TEST_CASE("a stamp that is none, or of another kind, is refused") {
  const LoadFailure magic = failure_of("wrong_magic");
  CHECK(magic.problem() == LoadProblem::bad_stamp);
  CHECK(said(magic) == "is no Shoal plugin: its stamp does not begin as one");
  const LoadFailure size = failure_of("short_stamp");
  CHECK(size.problem() == LoadProblem::bad_stamp);
  CHECK(said(size) == "has a damaged stamp: it is 40 bytes long instead of at least 112");
  const LoadFailure sizes = failure_of("other_sizes");
  CHECK(sizes.problem() == LoadProblem::other_sizes);
  CHECK(said(sizes) == "was built for numbers of 4 bytes and indices of 4, this Shoal for 8 and 4");
}

TEST_CASE("another major is refused before its code runs, with both versions and the way out") {
  // The library aborts in its static constructors; that this test ends shows that they did not run.
  const LoadFailure failure = failure_of("newer_major");
  CHECK(failure.problem() == LoadProblem::abi_major);
  CHECK(said(failure) ==
        "was built for version 2.3 of the plugin interface, this Shoal has version 1.3; rebuild it: cmake -S "
        "SOURCES_OF_newer_major -B build && cmake --build build --clean-first");
  REQUIRE(failure.notes().size() == 1);
  CHECK(failure.notes()[0] == "it was made with SDK 9.8.7 and test compiler 1");
}

TEST_CASE("in a build tree the command to rebuild is the exact one") {
  const fs::path tree = scratch("tree");
  fs::create_directories(tree / "plugins");
  std::ofstream(tree / "CMakeCache.txt") << "\n";
  fs::copy_file(folder / "newer_major.so", tree / "plugins/newer_major.so");
  const std::string text = failure_of("newer_major", {}, tree / "plugins").what();
  CHECK_MESSAGE(
      text.ends_with("; rebuild it: cmake --build " + tree.string() + " --target shoal_plugin_newer_major"),
      text);
}

TEST_CASE("code for another processor is refused before it runs") {
  const LoadFailure failure = failure_of("other_isa");
  CHECK(failure.problem() == LoadProblem::isa);
  CHECK(said(failure) ==
        "needs an instruction set that this version of Shoal does not know (bit 31); use a newer Shoal");
}

TEST_CASE("files that are no plugins") {
  const fs::path place = scratch("files");
  fs::create_directory(place / "directory.so");
  std::ofstream(place / "text.so") << "#!/bin/sh\necho a script\n";
  std::ofstream(place / "empty.so").flush();
  fs::create_symlink(place / "gone", place / "dangling.so");
  const auto check = [&](const std::string& id, LoadProblem problem, const std::string& text) {
    const LoadFailure failure = failure_of(id, {}, place);
    CHECK(failure.problem() == problem);
    CHECK(failure.what() == "plugin '" + id + "' (" + (place / (id + ".so")).string() + ") " + text);
  };
  check("directory", LoadProblem::not_a_file, "is a folder, not a library");
  check("text", LoadProblem::not_a_library, "is not a shared library");
  check("empty", LoadProblem::not_a_library, "is not a shared library");
  check("dangling", LoadProblem::not_a_file, "cannot be read: No such file or directory");
  const LoadFailure none = failure_of("no_stamp");
  CHECK(none.problem() == LoadProblem::no_stamp);
  CHECK(said(none) ==
        "is no Shoal plugin: it has no symbol shoal_plugin_stamp (a plugin has one SHOAL_PLUGIN(...), and "
        "its file "
        "keeps its section headers)");
}

TEST_CASE("a file that ends too early is refused, wherever it ends") {
  const fs::path place = scratch("truncated");
  const auto size = fs::file_size(folder / "good.so");
  // Without the check, dlopen maps pages behind the end of the file and the process dies of SIGBUS.
  for (std::uintmax_t bytes = 4; bytes < size; bytes += 97) {
    const std::string id = "cut_" + std::to_string(bytes);
    fs::copy_file(folder / "good.so", place / (id + ".so"));
    fs::resize_file(place / (id + ".so"), bytes);
    const LoadFailure failure = failure_of(id, {}, place);
    CHECK(failure.problem() == LoadProblem::truncated);
    CHECK(std::string(failure.what()).ends_with(") ends too early: it was copied or written only in part"));
    fs::remove(place / (id + ".so"));
  }
}

TEST_CASE("a library with damaged bytes in its tables is refused or loaded, but never kills the reader") {
  const fs::path place = scratch("damaged");
  std::ifstream file(folder / "wrong_magic.so", std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(file), {}};
  // wrong_magic is refused when it is whole, so nothing here reaches dlopen, whatever the damage.
  unsigned random = 1;
  for (int k = 0; k < 2000; ++k) {
    std::string bytes = sound;
    random = random * 1664525u + 1013904223u;
    const bool in_header = k % 2 == 0;
    const std::size_t at = in_header ? 4 + (random >> 8) % 700 : (random >> 8) % bytes.size();
    bytes[at] = static_cast<char>(random >> 3);
    const std::string id = "damaged_" + std::to_string(k);
    std::ofstream(place / (id + ".so"), std::ios::binary) << bytes;
    const LoadFailure failure = failure_of(id, {}, place);
    CHECK(failure.problem() <= LoadProblem::isa);
    fs::remove(place / (id + ".so"));
  }
}

TEST_CASE("what the dynamic linker misses is named") {
  const LoadFailure symbol = failure_of("undefined_symbol");
  CHECK(symbol.problem() == LoadProblem::undefined_symbol);
  CHECK(said(symbol) == "uses the symbol 'function_of_nobody', which no library provides");
  REQUIRE(symbol.notes().size() == 1);
  CHECK(symbol.notes()[0] ==
        "a plugin may use nothing of the kernel or of other plugins but what its host table offers; link it "
        "with "
        "-Wl,--no-undefined to see this when it is built");
  const LoadFailure library = failure_of("missing_library");
  CHECK(library.problem() == LoadProblem::missing_library);
  CHECK(said(library) == "needs the library libcompany.so, which is not on this machine");
}

TEST_CASE("an entry that is missing, fails or throws") {
  const LoadFailure missing = failure_of("no_entry");
  CHECK(missing.problem() == LoadProblem::no_entry);
  CHECK(said(missing) == "has a stamp but no function shoal_plugin_entry");
  const LoadFailure fails = failure_of("entry_fails");
  CHECK(fails.problem() == LoadProblem::entry_failed);
  CHECK(said(fails) == "did not start: no licence server answers");
  const LoadFailure silent = failure_of("entry_is_silent");
  CHECK(silent.problem() == LoadProblem::entry_failed);
  CHECK(said(silent) == "did not start: it failed without saying why (a plugin says why through host->fail)");
  const LoadFailure throws = failure_of("entry_throws");
  CHECK(throws.problem() == LoadProblem::entry_failed);
  CHECK(said(throws) ==
        "did not start: an exception left the plugin, which its callbacks must not let happen: out of the "
        "entry");
}

TEST_CASE("a description that cannot be right") {
  const LoadFailure id = failure_of("other_id");
  CHECK(id.problem() == LoadProblem::other_id);
  CHECK(said(id) == "calls itself 'real_name'; its file must be named real_name.so");
  const LoadFailure version = failure_of("bad_version");
  CHECK(version.problem() == LoadProblem::bad_description);
  CHECK(said(version) == "describes itself wrongly: its version 'latest' is not of the form 1.2.3");
}

TEST_CASE("a newer minor with longer structs is loaded, with what it requires before it") {
  Loader loader(in(folder));
  const LoadedPlugin& plugin = loader.load("newer_minor");
  CHECK(plugin.types.size() == 3);
  REQUIRE(plugin.requirements.size() == 2);
  CHECK(plugin.requirements[1].id == "another");  // read with the distance of the longer structs
  CHECK(plugin.requirements[1].versions.below == "3.0.0");
  REQUIRE(loader.loaded().size() == 3);
  CHECK(loader.loaded()[0]->id == "good");
  CHECK(loader.loaded()[1]->id == "another");
  CHECK(loader.loaded()[2]->id == "newer_minor");
}

TEST_CASE("requirements are loaded first, once") {
  Loader loader(in(folder));
  loader.load("on_top");
  loader.load("good");
  REQUIRE(loader.loaded().size() == 3);
  CHECK(loader.loaded()[0]->id == "good");
  CHECK(loader.loaded()[1]->id == "on_good");
  CHECK(loader.loaded()[2]->id == "on_top");
}

TEST_CASE("requirements that cannot be met are explained") {
  const LoadFailure missing = failure_of("on_missing");
  CHECK(missing.problem() == LoadProblem::requirement);
  CHECK(said(missing) == "requires plugin 'nowhere', which cannot be loaded: there is no plugin 'nowhere'");
  CHECK(std::find(missing.notes().begin(), missing.notes().end(),
                  "searched: " + folder.string() + " (--plugin-path)") != missing.notes().end());

  const std::string good = "plugin 'good' (" + (folder / "good.so").string() + ") has version 1.0.0, but ";
  const LoadFailure newer = failure_of("on_newer");
  CHECK(newer.problem() == LoadProblem::version);
  CHECK(newer.what() == good + "plugin 'on_newer' needs at least 1.1.0");
  const LoadFailure older = failure_of("on_older");
  CHECK(older.what() == good + "plugin 'on_older' needs a version below 1.0.0");
  const LoadFailure asked = failure_of("good", {"1.0.1", ""});
  CHECK(asked.what() == good + "the case needs at least 1.0.1");

  const std::string broken = failure_of("on_broken").what();
  CHECK_MESSAGE(broken.find("requires plugin 'newer_major', which cannot be loaded: plugin 'newer_major'") !=
                    std::string::npos,
                broken);
}

TEST_CASE("plugins that require one another are named in the order of the circle") {
  for (int k = 0; k < 2; ++k) {
    Loader loader(in(folder));
    CHECK_THROWS_WITH_AS(loader.load("ring_a"),
                         "plugins require one another in a circle: ring_a -> ring_b -> ring_c -> ring_a",
                         LoadFailure);
    // The first answer stays: no half of the circle can be used.
    CHECK_THROWS_AS(loader.load("ring_c"), LoadFailure);
    CHECK(loader.loaded().empty());
  }
  CHECK(std::string(failure_of("on_itself").what()) ==
        "plugins require one another in a circle: on_itself -> on_itself");
}

TEST_CASE("a failure keeps nothing from being loaded afterwards") {
  Loader loader(in(folder));
  CHECK_THROWS_AS(loader.load("entry_fails"), LoadFailure);
  CHECK_THROWS_WITH_AS(loader.load("on_missing"), doctest::Contains("nowhere"), LoadFailure);
  CHECK_THROWS_WITH_AS(loader.load("on_missing"), doctest::Contains("nowhere"), LoadFailure);
  CHECK(loader.load("good").id == "good");
}

TEST_CASE("the listing shows each file with its plugin or the reason why there is none") {
  const fs::path first = scratch("listing_first"), second = scratch("listing_second");
  fs::copy_file(folder / "good.so", first / "good.so");
  fs::copy_file(folder / "good.so", second / "good.so");
  fs::copy_file(folder / "no_entry.so", second / "no_entry.so");
  std::ofstream(second / "README.md") << "not a plugin\n";
  SearchSettings settings;
  settings.command_line = {first};
  settings.environment = second.string();
  const SearchPath search_path(settings);
  const auto list = list_plugins(search_path);
  REQUIRE(list.size() == 3);
  CHECK(list[0].path == first / "good.so");
  CHECK(list[0].origin == "--plugin-path");
  REQUIRE(list[0].plugin);
  CHECK(list[0].plugin->types.size() == 1);
  CHECK(list[0].hidden_by.empty());
  CHECK(list[1].path == second / "good.so");
  CHECK(list[1].origin == "SHOAL_PLUGIN_PATH");
  CHECK(list[1].hidden_by == first / "good.so");
  CHECK(list[2].id == "no_entry");
  CHECK_FALSE(list[2].plugin);
  CHECK(list[2].failure.ends_with("has a stamp but no function shoal_plugin_entry"));
}
