// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// describe, plugins and schema: what there is. A plugin is opened only where it is spoken of.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "kernel/app/commands.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/app/session.hpp"
#include "kernel/app/text.hpp"
#include "kernel/case/describe.hpp"
#include "kernel/case/sections.hpp"

namespace shoal::kernel::app {
namespace {

std::string first_sentence(const char* doc) {
  const std::string text = doc != nullptr ? doc : "";
  // The next one begins with a capital: "e.g. a wall" is not an end.
  for (std::size_t end = text.find(". "); end != std::string::npos; end = text.find(". ", end + 1))
    if (end + 2 < text.size() && std::isupper(static_cast<unsigned char>(text[end + 2])) != 0)
      return text.substr(0, end + 1);
  return text;
}

std::string owner_of(const RegisteredType& type) {
  const std::string kind = type_kind_name(type.kind);
  return type.plugin.empty() ? kind + " of Shoal itself"
                             : kind + " of plugin " + type.plugin + " " + type.plugin_version;
}

// The kernel's own or a plugin's types, by kind.
std::string types_text(const Registry& registry, const std::string& plugin) {
  std::string text;
  for (const shoal_type_kind kind : {SHOAL_TYPE_PHYSICS, SHOAL_TYPE_OPERATOR, SHOAL_TYPE_MATERIAL,
                                     SHOAL_TYPE_SHAPE, SHOAL_TYPE_OUTPUT, SHOAL_TYPE_PROBE}) {
    std::vector<std::vector<std::string>> rows;
    for (const RegisteredType& type : registry.types())
      if (type.kind == kind && type.plugin == plugin)
        rows.push_back({type.name, first_sentence(type.table.doc)});
    if (!rows.empty()) text += type_kind_plural(kind) + "\n" + table(rows, 2, "  ");
  }
  return text;
}

std::string sections_text() {
  std::vector<std::vector<std::string>> rows;
  for (const shoal_type* section : section_tables())
    rows.push_back({section->name, first_sentence(section->doc)});
  return "sections of a case\n" + table(rows, 2, "  ");
}

// Opens the plugin and those that it requires, and registers them.
const LoadedPlugin& open_plugin(Workshop& workshop, const std::string& id) {
  const std::size_t before = workshop.loader.loaded().size();
  const LoadedPlugin& plugin = workshop.loader.load(id);
  for (std::size_t k = before; k < workshop.loader.loaded().size(); ++k)
    workshop.registry.add(*workshop.loader.loaded()[k]);
  return plugin;
}

bool is_available(const Workshop& workshop, const std::string& id) {
  const std::vector<std::string> ids = workshop.loader.search_path().available();
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::string plugin_text(const LoadedPlugin& plugin, const Registry& registry) {
  std::string text = fmt::format("plugin {} {}: {}\n", plugin.id, plugin.version_text, plugin.summary);
  if (!plugin.citation.empty()) text += "cite: " + plugin.citation + "\n";
  return text + types_text(registry, plugin.id);
}

std::string everything_text(const Workshop& workshop) {
  std::string text = sections_text() + types_text(workshop.registry, "");
  const std::vector<std::string> plugins = workshop.loader.search_path().available();
  text += "plugins: " +
          (plugins.empty() ? std::string("none found (shoal plugins says where they are looked for)")
                           : join(plugins)) +
          "\n";
  return text + "more about each: shoal describe NAME\n";
}

const shoal_type* find_section(const std::string& name) {
  if (name == "case") return &case_table();
  for (const shoal_type* section : section_tables())
    if (name == section->name) return section;
  return section_table(name);
}

// A key of the case that is no section of its own, such as resolution.
std::optional<shoal_type> find_key_of_case(const std::string& name) {
  shoal_type alone = case_table();
  for (std::uint32_t k = 0; k < case_table().n_parameters; ++k) {
    if (case_table().parameters[k].key != name) continue;
    alone.parameters = case_table().parameters + k;
    alone.n_parameters = 1;
    return alone;
  }
  return std::nullopt;
}

[[noreturn]] void unknown(const Workshop& workshop, const std::string& name) {
  std::vector<std::string> known = section_keys();
  for (const shoal_type* section : section_tables()) known.emplace_back(section->name);
  for (const RegisteredType& type : workshop.registry.types()) known.push_back(type.name);
  for (const std::string& id : workshop.loader.search_path().available()) known.push_back(id);
  const Place place{std::make_shared<SourceText>(SourceText{"<describe " + name + ">", {}}), 0, 0, 0};
  throw UserError(place, "there is no section, type or plugin '" + name + "'" + did_you_mean(name, known),
                  {"shoal describe lists what there is"});
}

std::string description(Workshop& workshop, const std::string& name) {
  const std::string id = name.substr(0, name.find('.'));
  const bool available = is_available(workshop, id);
  const LoadedPlugin* plugin = available ? &open_plugin(workshop, id) : nullptr;
  std::string text;
  if (const shoal_type* section = find_section(name))
    text += describe_type(*section, "section");
  else if (const std::optional<shoal_type> key = find_key_of_case(name))
    text += describe_type(*key, "section");
  for (const RegisteredType* type : workshop.registry.find(name))
    text += describe_type(type->table, owner_of(*type));
  if (plugin != nullptr && name == id)
    text += (text.empty() ? "" : "\n") + plugin_text(*plugin, workshop.registry);
  if (text.empty()) unknown(workshop, name);
  return text;
}

}  // namespace

int describe(const Options& options) {
  Workshop workshop(options);
  std::string text;
  if (options.types.empty()) text = everything_text(workshop);
  for (const std::string& name : options.types)
    text += (text.empty() ? "" : "\n") + description(workshop, name);
  Console::print(text);
  Console::event({{"event", "describe"}, {"text", text}});
  return exit_done;
}

int list_plugins(const Options& options) {
  Workshop workshop(options);
  std::vector<std::vector<std::string>> rows;
  for (const PluginListing& listing : kernel::list_plugins(workshop.loader.search_path())) {
    const bool good = listing.plugin != nullptr;
    const std::string version = good ? listing.plugin->version_text : "";
    std::string says = good ? listing.plugin->summary : "cannot be loaded: " + listing.failure;
    if (!listing.hidden_by.empty()) says = "not used, since " + listing.hidden_by.string() + " comes first";
    rows.push_back({listing.id, version, says, listing.path.string()});
    Console::event({{"event", "plugin"},
                    {"id", listing.id},
                    {"version", version},
                    {"path", listing.path.string()},
                    {"origin", listing.origin},
                    {"hidden_by", listing.hidden_by.string()},
                    {"failure", listing.failure}});
  }
  Console::print(rows.empty() ? "no plugins found\n" : table(rows, 4, ""));
  std::string places = "looked for in\n";
  for (const std::string& line : workshop.loader.search_path().description()) places += "  " + line + "\n";
  Console::inform(places);
  return exit_done;
}

int print_schema(const Options& options) {
  Workshop workshop(options);
  for (const std::string& id : workshop.loader.search_path().available()) {
    try {
      open_plugin(workshop, id);
    } catch (const LoadFailure& failure) {
      Console::warning("plugin '" + id + "' is left out: " + failure.what());
    }
  }
  std::vector<const shoal_type*> types;
  for (const RegisteredType& type : workshop.registry.types()) types.push_back(&type.table);
  Console::raw(json_schema(types));
  return exit_done;
}

}  // namespace shoal::kernel::app
