// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/session.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "kernel/app/console.hpp"
#include "kernel/case/shapes.hpp"
#include "kernel/output/probes/probe.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel::app {
namespace {

SearchSettings search_settings(const Options& options, const std::vector<std::string>& of_case) {
  SearchSettings settings = SearchSettings::of_this_process();
  settings.command_line = options.plugin_paths;
  settings.of_case.assign(of_case.begin(), of_case.end());
  settings.allow_plugin_paths = options.allow_plugin_paths;
  return settings;
}

shoal_status evaluate(const shoal_expression* expression, std::int32_t dimensions, std::uint64_t n,
                      const double* position, double t, double* out) {
  Expression::from_handle(expression).evaluate(dimensions, n, position, t, out);
  return SHOAL_OK;
}

const char* name_in(const shoal_expression* expression, std::uint32_t k) {
  const std::vector<std::string>& names = Expression::from_handle(expression).fields();
  return k < names.size() ? names[k].c_str() : nullptr;
}

shoal_status evaluate_names(const shoal_expression* expression, std::int32_t dimensions, std::uint64_t n,
                            const double* position, const double* const* columns, double t, double* out) {
  Expression::from_handle(expression).evaluate(dimensions, n, position, columns, t, out);
  return SHOAL_OK;
}

// A place in words ("dam_break.yaml:12:51") as a place in the text, so that the message shows the line.
Place place_of(const std::string& words, const CaseFile& file) {
  const Place& top = file.root().place();
  const std::string prefix = top.file() + ":";
  if (top.source == nullptr || words.rfind(prefix, 0) != 0)
    return {std::make_shared<SourceText>(SourceText{words.empty() ? file.name() : words, {}}), 0, 0, 0};
  int line = 0, column = 1;
  const char* last = words.data() + words.size();
  const char* at = std::from_chars(words.data() + prefix.size(), last, line).ptr;
  if (at != last && *at == ':') std::from_chars(at + 1, last, column);
  const bool good = line >= 1 && static_cast<std::size_t>(line) <= top.source->lines.size();
  return good ? Place{top.source, line, column, 1} : Place{top.source, 0, 0, 0};
}

// Whether `a` requires `b`, directly or through others.
bool requires_plugin(const Loader& loader, std::string_view a, std::string_view b) {
  for (const LoadedPlugin* plugin : loader.loaded()) {
    if (plugin->id != a) continue;
    return std::any_of(plugin->requirements.begin(), plugin->requirements.end(),
                       [&](const Requirement& requirement) {
                         return requirement.id == b || requires_plugin(loader, requirement.id, b);
                       });
  }
  return false;
}

}  // namespace

Workshop::Workshop(const Options& options, const std::vector<std::string>& of_case)
    : loader(search_settings(options, of_case)), registry(check_parameter) {
  set_evaluate(evaluate);
  set_names(name_in, evaluate_names);
  registry.add_own(own_shape_types());
  registry.add_own(own_probe_types());
  for (const std::string& line : loader.search_path().description()) log(LogLevel::debug, "plugins: " + line);
}

Session::Session(const Options& options, const std::string& case_file, bool quick) {
  Diagnostics diagnostics;
  file_ = std::make_unique<CaseFile>(case_file, options.settings, diagnostics);
  if (!file_->readable()) {
    diagnostics.throw_if_errors();
    throw UserError(Place{}, "'" + case_file + "' cannot be read");
  }
  workshop_ = std::make_unique<Workshop>(options, file_->plugin_paths());
  read(diagnostics);
  try {
    build(options, quick);
  } catch (const ModelError& error) {
    throw UserError(place_of(error.place(), *file_), error.what());
  }
}

void Session::read(Diagnostics& diagnostics) {
  const RegistryCatalogue types = load_plugins(*file_, workshop_->loader, workshop_->registry, diagnostics);
  model_ = check_case(*file_, types, diagnostics);
  diagnostics.throw_if_errors();
  if (!diagnostics.empty() && !Console::quiet()) Console::warning(diagnostics.format());
}

void Session::build(const Options& options, bool quick) {
  AssemblyOptions assembly_options;
  assembly_options.threads = options.threads;
  assembly_options.skip_relaxation = quick;
  assembly_options.requires_plugin = [this](std::string_view a, std::string_view b) {
    return requires_plugin(workshop_->loader, a, b);
  };
  assembly_ = std::make_unique<Assembly>(assemble(*model_, assembly_options));
  recorder_ = std::make_unique<Recorder>(*model_, run());
  run().finalise();
  recorder_->bind(run());
}

Place option_place(const std::string& text) {
  return Place{std::make_shared<SourceText>(SourceText{text, {}}), 0, 0, 0};
}

double read_time(const std::string& option, const std::string& text) {
  Diagnostics diagnostics;
  const Place place = option_place("<" + option + " " + text + ">");
  const Node node = read_yaml_value(text, place, diagnostics);
  const std::optional<double> value = read_number(node, NumberRequest{"s", false}, Parameters{}, diagnostics);
  diagnostics.throw_if_errors();
  return value.value_or(0.0);
}

std::string case_name(const std::string& case_file) {
  const std::filesystem::path path(case_file);
  // The effective case of a results folder is named by the folder.
  if (path.filename() == "case.yaml" && path.has_parent_path()) return path.parent_path().filename().string();
  return path.stem().string();
}

}  // namespace shoal::kernel::app
