// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Registration of the types of real libraries: of later versions, and of authors who made mistakes.
#include "kernel/plugins/registry.hpp"

#include <doctest/doctest.h>

#include "kernel/plugins/host.hpp"

using namespace shoal::kernel;

namespace {

SearchSettings test_plugins() {
  SearchSettings settings;
  settings.command_line = {SHOAL_TEST_PLUGINS};
  return settings;
}

std::vector<std::string> problems_of(const std::string& id) {
  Loader loader(test_plugins());
  Registry registry;
  try {
    registry.add(loader.load(id));
  } catch (const TableError& error) {
    CHECK(registry.types().empty());
    CHECK(error.plugin() == id);
    return error.problems();
  }
  return {};
}

}  // namespace

TEST_CASE("types of a sound plugin are found by kind and name") {
  Loader loader(test_plugins());
  Registry registry;
  registry.add(loader.load("good"));
  const RegisteredType* type = registry.find(SHOAL_TYPE_PHYSICS, "good.type");
  REQUIRE(type);
  CHECK(type->plugin == "good");
  CHECK(type->original == loader.load("good").types[0]);
  REQUIRE(type->parameter("viscosity"));
  CHECK(std::string(type->parameter("viscosity")->unit) == "m2/s");
  CHECK_FALSE(type->parameter("density"));
  CHECK_FALSE(registry.find(SHOAL_TYPE_MATERIAL, "good.type"));
  CHECK(registry.find("good.type").size() == 1);
  CHECK(registry.names(SHOAL_TYPE_PHYSICS) == std::vector<std::string>{"good.type"});
}

TEST_CASE("longer structs of a newer minor are read, and what is too new is left out and remembered") {
  std::vector<std::string> messages;
  set_log_sink([&](LogLevel level, std::string_view text) {
    if (level == LogLevel::warning) messages.emplace_back(text);
  });
  Loader loader(test_plugins());
  Registry registry;
  registry.add(loader.load("newer_minor"));
  set_log_sink({});
  const RegisteredType* type = registry.find(SHOAL_TYPE_PHYSICS, "newer_minor.type");
  REQUIRE(type);
  REQUIRE(type->parameters.size() == 3);
  CHECK(std::string(type->parameters[1].key) == "second");
  CHECK(std::string(type->table.parameters[2].default_text) == "three");
  CHECK(type->table.size == sizeof(shoal_type));
  CHECK(registry.types().size() == 1);
  CHECK(messages ==
        std::vector<std::string>{
            "type 'newer_minor.later_kind' of plugin 'newer_minor' is for a newer Shoal and is left out",
            "type 'newer_minor.later_value' of plugin 'newer_minor' is for a newer Shoal and is left out"});
  const UnknownType why = registry.explain_unknown(SHOAL_TYPE_PHYSICS, "newer_minor.later_value", {});
  CHECK(why.needs_newer_shoal);
  CHECK(why.text == "'newer_minor.later_value' of plugin 'newer_minor' is for a newer Shoal than this one");
}

TEST_CASE("what an author does wrong is said at once, type by type and key by key") {
  CHECK(problems_of("duplicate_type") ==
        std::vector<std::string>{"duplicate_type.type: the plugin registers it twice"});
  CHECK(
      problems_of("foreign_prefix") ==
      std::vector<std::string>{
          "good.type: its name must be 'foreign_prefix' or begin with 'foreign_prefix.', all in snake_case"});
  CHECK(problems_of("short_type") == std::vector<std::string>{"a type is too short a struct"});
  CHECK(problems_of("unknown_kind") ==
        std::vector<std::string>{"unknown_kind.type: unknown kind 17 of type"});
  const std::string at = "bad_table.type, parameter ";
  const std::vector<std::string> expected = {
      "bad_table.type: the key 'Speed' is not in snake_case",
      at + "'twice': there are two parameters of this name",
      at + "'no_doc': it has no doc",
      at + "'no_unit': a number needs a unit; without dimension it is \"1\"",
      at + "'text_unit': a text has no unit",
      at + "'odd': unknown kind of value 99",
      at + "'half': the default '0.5' is no integer",
      at + "'outside': the default 0 lies outside its bounds",
      at + "'crossed': no number lies between its bounds",
      at + "'no_choice': there is nothing to choose from",
      at + "'other_choice': the default 'up' is not one of the choices",
      at + "'maybe': the default 'maybe' is neither true nor false",
      at + "'both': it is required, so it cannot have a default",
      at + "'thing': it does not say which kind of object fits",
  };
  CHECK(problems_of("bad_table") == expected);
}

TEST_CASE("two sources of one type are both named") {
  Loader loader(test_plugins());
  Registry registry;
  registry.add(loader.load("good"));
  // A second library of the same id, from another folder: nothing in one process loads it but a mistake.
  try {
    registry.add(loader.load("good"));
    FAIL("registered twice");
  } catch (const TableError& error) {
    CHECK(error.problems() ==
          std::vector<std::string>{"good.type: this physics is already registered by plugin 'good'"});
    CHECK(std::string(error.what())
              .starts_with("plugin 'good' (" SHOAL_TEST_PLUGINS "/good.so) describes its types "
                           "wrongly:\n  good.type: "));
  }
}

TEST_CASE("an unknown type is traced to the plugin that would have it") {
  Loader loader(test_plugins());
  Registry registry;
  registry.add(loader.load("good"));
  const auto available = loader.search_path().available();
  const UnknownType unlisted = registry.explain_unknown(SHOAL_TYPE_PHYSICS, "another.type", available);
  CHECK(unlisted.plugin_to_list == "another");
  CHECK(unlisted.text ==
        "types of this name come from plugin 'another', which is there but not listed under 'plugins:'");
  const UnknownType kind = registry.explain_unknown(SHOAL_TYPE_MATERIAL, "good.type", available);
  CHECK(kind.other_kinds == std::vector<shoal_type_kind>{SHOAL_TYPE_PHYSICS});
  CHECK(kind.text == "'good.type' is physics, not a material");
  const UnknownType nowhere = registry.explain_unknown(SHOAL_TYPE_PHYSICS, "magma.flow", available);
  CHECK(nowhere.text == "there is no plugin 'magma' that could provide it");
  const UnknownType misspelt = registry.explain_unknown(SHOAL_TYPE_PHYSICS, "good.tpye", available);
  CHECK(misspelt.text.empty());
}
