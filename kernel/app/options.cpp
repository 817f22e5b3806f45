// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The only file that knows CLI11.
#include "kernel/app/options.hpp"

#include <CLI/CLI.hpp>

#include <iostream>

#include "kernel/app/exit_code.hpp"
#include "kernel/build_info.hpp"

namespace shoal::kernel::app {
namespace {

std::string version_text() {
  return "shoal " + std::string(build_info::version) + " (" + std::string(build_info::compiler) + ", " +
         std::string(build_info::build_type) + ", " + std::string(build_info::flags) + ")";
}

void add_common(CLI::App& app, Options& options) {
  app.add_option("--plugin-path", options.plugin_paths, "Folder to look for plugins in, before all others")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  app.add_flag("--allow-plugin-paths", options.allow_plugin_paths,
               "Let a case name folders of plugins: their code runs with your rights");
  app.add_flag("--json", options.console.json, "One JSON object per line, for machines");
  app.add_flag("-q,--quiet", options.console.quiet, "Only results and errors");
  app.add_option("--log-level", options.console.level, "Messages to show")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->type_name("LEVEL")
      ->default_str("warning");
}

void add_case(CLI::App& app, Options& options) {
  app.add_option("CASE", options.case_file, "The case, a YAML file")->required()->type_name("");
}

void add_settings(CLI::App& app, Options& options) {
  app.add_option("--set", options.settings,
                 "Another value of a parameter or key: --set H=0.5m, --set run.end=1s")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--threads", options.threads, "Threads to compute with; all of the machine without it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
}

void add_running(CLI::App& app, Options& options) {
  app.add_flag("--strict", options.strict, "Exit code 3 if a reference is not met");
  app.add_option("--until", options.until, "Stop at the first step at or after this time: 0.5s")
      ->type_name("TIME");
  app.add_option("--steps", options.steps, "Stop after so many outer steps")->type_name("N");
  app.add_option("--checkpoint-every", options.checkpoint_every,
                 "Wall time between checkpoints, beside those of the case; 0 for none")
      ->type_name("TIME")
      ->default_str("30 min");
}

// What study and report have in common.
void add_bounds(CLI::App& app, Options& options) {
  app.add_flag(
      "--limits", options.limits,
      "Find the longest stable steps: raise each factor of time steps that the physics declares until a run "
      "fails");
  app.add_option(
         "--within", options.within,
         "Wall time for the runs of a case, and again for its limits; what is not done then is left out, and "
         "goes on when called again with more")
      ->type_name("TIME");
}

void add_study(CLI::App& app, Options& options) {
  app.add_option(
         "--vary", options.vary,
         "Values of a parameter or key: --vary dx=0.1,0.05; more make a matrix. Without it, those that the "
         "case names under 'study'")
      ->type_name("KEY=VALUE,...")
      ->allow_extra_args(false);
  app.add_option(
         "--ensemble", options.ensemble,
         "Values between which runs differ by chance alone: references are compared with the mean over "
         "them. Without it, what the case names under 'ensemble'")
      ->type_name("KEY=VALUE,...");
  app.add_option("--want", options.want,
                 "Name the cheapest run within an error, of the first reference or of a probe: error=1%")
      ->type_name("PROBE=ERROR");
  app.add_option("--limit", options.limit,
                 "The same for one key, from its value in the case or from another one: --limit "
                 "physics.0.fluid.wcsph.acoustic_cfl")
      ->type_name("KEY[=VALUE]")
      ->allow_extra_args(false);
  add_bounds(app, options);
  app.add_option("-o,--output", options.output, "Folder of the study; ./results/NAME_study without it")
      ->type_name("FOLDER");
  app.add_flag("-f,--force", options.force, "Run all anew, also what has results");
  app.add_flag("--strict", options.strict,
               "Exit code 3 if a reference is not met: by a mean where there is an ensemble, else by a run");
}

void add_report(CLI::App& app, Options& options) {
  app.add_option("CASES", options.cases, "Cases, or folders of cases; ./cases without it")->type_name("");
  app.add_option("-o,--output", options.output, "Folder of the report; ./docs/report without it")
      ->type_name("FOLDER");
  add_bounds(app, options);
  app.add_option("--results", options.folder, "Folder of the studies; what is there is not run again")
      ->type_name("FOLDER")
      ->default_str("results/report");
  app.add_option("--threads", options.threads, "Threads to compute with; all of the machine without it")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  app.add_flag("-f,--force", options.force, "Run all anew, also what has results");
}

struct Commands {
  CLI::App *run, *check, *plan, *study, *report, *describe, *plugins, *resume, *schema;
};

Commands add_commands(CLI::App& app, Options& options) {
  Commands c{};
  c.run = app.add_subcommand("run", "Run a case");
  add_case(*c.run, options);
  add_settings(*c.run, options);
  c.run->add_option("-o,--output", options.output, "Folder of the results; ./results/NAME without it")
      ->type_name("FOLDER");
  c.run->add_flag("-f,--force", options.force, "Replace the results of an earlier run");
  add_running(*c.run, options);

  c.check = app.add_subcommand("check", "Check a case, all of it, without running it");
  add_case(*c.check, options);
  add_settings(*c.check, options);

  c.plan = app.add_subcommand("plan", "Show what a case consists of: loops, operators, fields, memory");
  add_case(*c.plan, options);
  add_settings(*c.plan, options);

  c.study = app.add_subcommand("study", "Run a case in all combinations of some values: error against cost");
  add_case(*c.study, options);
  add_study(*c.study, options);
  add_settings(*c.study, options);

  c.report = app.add_subcommand("report", "Study cases and write a report: error, cost, pictures, plans");
  add_report(*c.report, options);

  c.resume = app.add_subcommand("resume", "Go on with a run from its newest checkpoint");
  c.resume->add_option("FOLDER", options.folder, "The results of the run")->required()->type_name("");
  add_settings(*c.resume, options);
  c.resume->add_flag("-f,--force", options.force, "Go on even if the case describes another computation now");
  add_running(*c.resume, options);

  c.describe = app.add_subcommand("describe", "Explain a section, a plugin or a type, and its keys");
  c.describe
      ->add_option("TYPE", options.types, "bodies, fluid, fluid.wcsph, box ...; all there is without it")
      ->type_name("");
  c.plugins = app.add_subcommand("plugins", "List the plugins that are found, or why they are not");
  c.schema = app.add_subcommand("schema", "Print the JSON schema of cases, for the completion of editors");
  for (CLI::App* command :
       {c.run, c.check, c.plan, c.study, c.report, c.resume, c.describe, c.plugins, c.schema})
    add_common(*command, options);
  return c;
}

}  // namespace

std::optional<int> read_command_line(int argc, char** argv, Options& options) {
  CLI::App app("Shoal: smoothed particle hydrodynamics with plugins", "shoal");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "First steps:  shoal run cases/fluid/dam_break_2d.yaml\n"
      "              shoal describe\n"
      "Exit codes: 0 done, 1 the program failed, 2 the case or the command is wrong, 3 the physics failed,\n"
      "130 interrupted (a checkpoint was written)");
  const Commands commands = add_commands(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? exit_done : exit_wrong_case;
  }
  const std::vector<std::pair<CLI::App*, Command>> all{
      {commands.run, Command::run},         {commands.check, Command::check},
      {commands.plan, Command::plan},       {commands.study, Command::study},
      {commands.report, Command::report},   {commands.describe, Command::describe},
      {commands.plugins, Command::plugins}, {commands.resume, Command::resume},
      {commands.schema, Command::schema}};
  for (const auto& [app_of_command, command] : all)
    if (app_of_command->parsed()) options.command = command;
  return std::nullopt;
}

}  // namespace shoal::kernel::app
