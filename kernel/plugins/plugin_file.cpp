// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The one file with Boost.DLL. Libraries are never closed: types, callbacks and their texts live in them, and
// code that was unloaded while something still points to it is the classical crash at the end of a program.
#include "kernel/plugins/plugin_file.hpp"

#include <algorithm>
#include <boost/dll/shared_library.hpp>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <system_error>

#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"
#include "kernel/plugins/isa.hpp"
#include "kernel/plugins/search_path.hpp"
#include "kernel/plugins/stamp_reader.hpp"

namespace shoal::kernel {
namespace fs = std::filesystem;
namespace {

std::string version_text(unsigned major, unsigned minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

std::string quoted(const std::string& id, const fs::path& path) {
  return "plugin '" + id + "' (" + path.string() + ")";
}

// The command that makes this file anew: its build tree, if it stands in one as this project makes them.
std::string rebuild_command(const std::string& id, const fs::path& path) {
  const fs::path tree = path.parent_path().parent_path();
  std::error_code error;
  if (fs::exists(tree / "CMakeCache.txt", error))
    return "cmake --build " + tree.string() + " --target shoal_plugin_" + id;
  return "cmake -S SOURCES_OF_" + id + " -B build && cmake --build build --clean-first";
}

std::string text_of(const char* array, std::size_t length) { return {array, strnlen(array, length)}; }

std::string made_with(const shoal_stamp& stamp) {
  const std::string sdk = text_of(stamp.sdk_version, sizeof(stamp.sdk_version));
  const std::string compiler = text_of(stamp.compiler, sizeof(stamp.compiler));
  return "it was made with SDK " + (sdk.empty() ? "?" : sdk) + " and " + (compiler.empty() ? "?" : compiler);
}

// The part of `text` between two phrases; empty if it has not both.
std::string between(const std::string& text, std::string_view before, std::string_view after) {
  const auto begin = text.find(before);
  if (begin == std::string::npos) return {};
  const auto end = text.find_first_of(after, begin + before.size());
  return text.substr(begin + before.size(), end == std::string::npos ? end : end - begin - before.size());
}

// `text` is glibc's inside Boost's: "... (dlerror system message: x.so: undefined symbol: foo): ...".
LoadFailure explain_dlerror(const std::string& id, const fs::path& path, const std::string& text) {
  const auto failure = [&](LoadProblem problem, const std::string& what, std::vector<std::string> notes) {
    return LoadFailure(problem, id, path, quoted(id, path) + " " + what, std::move(notes));
  };
  if (const std::string symbol = between(text, "undefined symbol: ", " ,)"); !symbol.empty())
    return failure(
        LoadProblem::undefined_symbol, "uses the symbol '" + symbol + "', which no library provides",
        {"a plugin may use nothing of the kernel or of other plugins but what its host table offers; "
         "link it with -Wl,--no-undefined to see this when it is built"});
  if (const std::string version = between(text, "version `", "'"); !version.empty())
    return failure(LoadProblem::missing_library,
                   "was built with newer system libraries than this machine has (it needs " + version + ")",
                   {"build it on this machine, or on one with the same system"});
  constexpr std::string_view begin = "dlerror system message: ";
  std::string message = between(text, begin, "");
  if (message.empty()) message = text;
  if (const auto at = message.find(": cannot open shared object file"); at != std::string::npos)
    return failure(LoadProblem::missing_library,
                   "needs the library " + message.substr(0, at) + ", which is not on this machine",
                   {"install the package that holds it, then run again"});
  return failure(LoadProblem::not_loadable, "cannot be loaded: " + message, {});
}

// Never destroyed, see above. An exception out of a static object's constructor cannot be caught here: it finds no
// way through the dynamic linker, and the C++ runtime ends the process with its text.
boost::dll::shared_library& map_library(const std::string& id, const fs::path& path) {
  using boost::dll::load_mode::rtld_local;
  using boost::dll::load_mode::rtld_now;
  static auto* const libraries = new std::vector<std::unique_ptr<boost::dll::shared_library>>;
  auto library = std::make_unique<boost::dll::shared_library>();
  try {
    library->load(path, rtld_now | rtld_local);
  } catch (const std::system_error& error) {
    throw explain_dlerror(id, path, error.what());
  }
  return *libraries->emplace_back(std::move(library));
}

const shoal_plugin& call_entry(const std::string& id, const fs::path& path,
                               boost::dll::shared_library& library) {
  if (!library.has(SHOAL_ENTRY_SYMBOL))
    throw LoadFailure(LoadProblem::no_entry, id, path,
                      quoted(id, path) + " has a stamp but no function " SHOAL_ENTRY_SYMBOL,
                      {"a plugin has exactly one SHOAL_PLUGIN(...)"});
  const auto entry = reinterpret_cast<shoal_plugin_entry_function>(
      reinterpret_cast<void*>(&library.get<unsigned char>(SHOAL_ENTRY_SYMBOL)));
  const shoal_plugin* plugin = nullptr;
  try {
    call_plugin(id, {}, [&] {
      plugin = entry(&plugin_host());
      return plugin ? SHOAL_OK : SHOAL_ERROR;
    });
  } catch (const PluginFailure& failure) {
    throw LoadFailure(LoadProblem::entry_failed, id, path,
                      quoted(id, path) + " did not start: " + failure.text());
  }
  return *plugin;
}

std::string text_or_empty(const char* text) { return text ? text : ""; }

[[noreturn]] void refuse_description(const std::string& id, const fs::path& path, const std::string& what) {
  throw LoadFailure(LoadProblem::bad_description, id, path,
                    quoted(id, path) + " describes itself wrongly: " + what);
}

void read_requirements(LoadedPlugin& plugin, const shoal_plugin& own) {
  const auto refuse = [&](const std::string& what) { refuse_description(plugin.id, plugin.path, what); };
  if (own.n_requirements > 0 && !own.requirements) refuse("it counts requirements but lists none");
  for (std::uint32_t k = 0; k < own.n_requirements; ++k) {
    const auto* requirement = abi_element(own.requirements, k);
    if (requirement->size < abi_smallest<shoal_requirement>) refuse("a requirement is too short a struct");
    Requirement known{
        text_or_empty(requirement->id),
        {text_or_empty(requirement->minimum_version), text_or_empty(requirement->below_version)}};
    if (!is_snake_case(known.id))
      refuse("it requires '" + known.id + "', which cannot be the id of a plugin");
    for (const std::string& bound : {known.versions.at_least, known.versions.below})
      if (!bound.empty() && !parse_version(bound))
        refuse("it requires '" + known.id + "' in version '" + bound + "', which is not of the form 1.2.3");
    plugin.requirements.push_back(std::move(known));
  }
}

LoadedPlugin describe(const std::string& id, const fs::path& path, const shoal_stamp& stamp,
                      const shoal_plugin& own) {
  const auto refuse = [&](const std::string& what) { refuse_description(id, path, what); };
  if (own.size < abi_smallest<shoal_plugin>) refuse("its struct shoal_plugin is too short");
  const shoal_plugin copy = abi_copy(&own);
  LoadedPlugin plugin;
  plugin.id = text_or_empty(copy.id);
  plugin.path = path;
  plugin.stamp = stamp;
  if (plugin.id != id)
    throw LoadFailure(
        LoadProblem::other_id, id, path,
        quoted(id, path) + " calls itself '" + plugin.id + "'; its file must be named " + plugin.id + ".so");
  plugin.version_text = text_or_empty(copy.version);
  const auto version = parse_version(plugin.version_text);
  if (!version) refuse("its version '" + plugin.version_text + "' is not of the form 1.2.3");
  plugin.version = *version;
  plugin.licence = text_or_empty(copy.licence);
  plugin.summary = text_or_empty(copy.summary);
  plugin.citation = text_or_empty(copy.citation);
  if (plugin.licence.empty()) refuse("it names no licence");
  if (plugin.summary.empty()) refuse("it has no summary");
  read_requirements(plugin, copy);
  if (copy.n_types > 0 && !copy.types) refuse("it counts types but lists none");
  for (std::uint32_t k = 0; k < copy.n_types; ++k) {
    if (!copy.types[k]) refuse("type " + std::to_string(k + 1) + " of its list is missing");
    plugin.types.push_back(copy.types[k]);
  }
  return plugin;
}

LoadedPlugin open(const fs::path& path, const std::string& id) {
  const StampReading reading = read_stamp(path);
  if (!reading.stamp) throw LoadFailure(reading.problem, id, path, quoted(id, path) + " " + reading.text);
  const shoal_stamp& stamp = *reading.stamp;
  if (const auto wrong = check_stamp(stamp, SHOAL_ABI_MAJOR, SHOAL_ABI_MINOR, isa_of_machine())) {
    std::string text = quoted(id, path) + " " + wrong->text;
    std::vector<std::string> notes;
    if (wrong->problem == LoadProblem::abi_major) text += "; rebuild it: " + rebuild_command(id, path);
    if (wrong->problem != LoadProblem::bad_stamp) notes.push_back(made_with(stamp));
    throw LoadFailure(wrong->problem, id, path, text, notes);
  }
  boost::dll::shared_library& library = map_library(id, path);
  return describe(id, path, stamp, call_entry(id, path, library));
}

}  // namespace

std::optional<StampProblem> check_stamp(const shoal_stamp& stamp, unsigned major, unsigned minor,
                                        std::uint32_t isa) {
  if (stamp.magic != SHOAL_ABI_MAGIC)
    return StampProblem{LoadProblem::bad_stamp, "is no Shoal plugin: its stamp does not begin as one"};
  if (stamp.size < offsetof(shoal_stamp, real_bytes))
    return StampProblem{LoadProblem::bad_stamp, "has a damaged stamp: it is too short to hold a version"};
  // From here on a stamp of another major may mean anything, so this comes first.
  if (stamp.abi_major != major)
    return StampProblem{LoadProblem::abi_major,
                        "was built for version " + version_text(stamp.abi_major, stamp.abi_minor) +
                            " of the plugin interface, this Shoal has version " + version_text(major, minor)};
  if (stamp.size < abi_smallest<shoal_stamp>)
    return StampProblem{LoadProblem::bad_stamp, "has a damaged stamp: it is " + std::to_string(stamp.size) +
                                                    " bytes long instead of at least " +
                                                    std::to_string(abi_smallest<shoal_stamp>)};
  if (stamp.real_bytes != sizeof(double) || stamp.index_bytes != sizeof(std::uint32_t))
    return StampProblem{LoadProblem::other_sizes,
                        "was built for numbers of " + std::to_string(stamp.real_bytes) +
                            " bytes and indices of " + std::to_string(stamp.index_bytes) +
                            ", this Shoal for " + std::to_string(sizeof(double)) + " and " +
                            std::to_string(sizeof(std::uint32_t))};
  if (std::string text = isa_problem(stamp.isa, isa); !text.empty())
    return StampProblem{LoadProblem::isa, std::move(text)};
  return std::nullopt;
}

const LoadedPlugin& open_plugin_file(const fs::path& path, const std::string& id) {
  struct Opened {
    std::unique_ptr<LoadedPlugin> plugin;
    std::unique_ptr<LoadFailure> failure;
  };
  static auto* const opened = new std::map<fs::path, Opened>;
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(path, error);
  if (error) canonical = path;
  const auto [place, is_new] = opened->try_emplace(canonical);
  Opened& known = place->second;
  if (is_new) {
    try {
      known.plugin = std::make_unique<LoadedPlugin>(open(path, id));
    } catch (const LoadFailure& failure) {
      known.failure = std::make_unique<LoadFailure>(failure);
    }
  }
  if (known.failure) throw LoadFailure(*known.failure);
  return *known.plugin;
}

}  // namespace shoal::kernel
