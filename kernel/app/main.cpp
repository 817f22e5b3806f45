// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The program: reads the command line, does what it asks for, and turns what went wrong into words and an exit code.
#include <exception>
#include <new>

#include "kernel/app/commands.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/case/diagnostics.hpp"
#include "kernel/output/result_folder.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/errors.hpp"

#ifdef __has_feature
#define SHOAL_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define SHOAL_ADDRESS_SANITIZER 1
#endif

#if SHOAL_ADDRESS_SANITIZER
// LeakSanitizer of gcc 12 and clang 14 falls over the thread-local storage of VTK's libraries, which a plugin opens. So it
// does not look there, and takes for lost what the loader of the system keeps there.
#define SHOAL_LSAN extern "C" __attribute__((visibility("default"))) const char*
SHOAL_LSAN __lsan_default_options();  // NOLINT
SHOAL_LSAN __lsan_default_options() { return "use_tls=0:print_suppressions=0"; }
SHOAL_LSAN __lsan_default_suppressions();  // NOLINT
SHOAL_LSAN __lsan_default_suppressions() { return "leak:_dlerror_run\nleak:add_to_global_resize\n"; }
#endif

namespace shoal::kernel::app {
namespace {

int execute(const Options& options) {
  switch (options.command) {
    case Command::run: return run_case(options);
    case Command::resume: return resume_case(options);
    case Command::check: return check_case_file(options);
    case Command::plan: return plan_case(options);
    case Command::study: return study_case(options);
    case Command::report: return write_report(options);
    case Command::describe: return describe(options);
    case Command::plugins: return list_plugins(options);
    case Command::schema: return print_schema(options);
  }
  return exit_program_failed;
}

int told(int code, const std::string& text) {
  Console::status("");
  Console::error(text);
  return code;
}

int guarded(const Options& options) {
  try {
    return execute(options);
  } catch (const UserError& error) {
    return told(exit_wrong_case, error.what());
  } catch (const FolderError& error) {
    return told(exit_wrong_case, std::string("error: ") + error.what());
  } catch (const ModelError& error) {
    return told(exit_wrong_case,
                (error.place().empty() ? "error: " : error.place() + ": error: ") + error.what());
  } catch (const LoadFailure& error) {
    std::string text = std::string("error: ") + error.what();
    for (const std::string& note : error.notes()) text += "\n  " + note;
    return told(exit_wrong_case, text);
  } catch (const PhysicsFailure& error) {
    return told(exit_physics_failed, std::string("error: ") + error.what());
  } catch (const PluginFailure& error) {
    const int code = error.status() == SHOAL_CASE_ERROR       ? exit_wrong_case
                     : error.status() == SHOAL_PHYSICS_FAILED ? exit_physics_failed
                                                              : exit_program_failed;
    return told(code, std::string("error: ") + error.what());
  } catch (const std::bad_alloc&) {
    return told(exit_program_failed,
                "error: there is not enough memory (shoal plan CASE says how much it takes)");
  } catch (const std::exception& error) {
    return told(exit_program_failed, std::string("error: ") + error.what());
  }
}

}  // namespace
}  // namespace shoal::kernel::app

int main(int argc, char** argv) {
  using namespace shoal::kernel::app;
  Options options;
  if (const std::optional<int> code = read_command_line(argc, argv, options)) return *code;
  Console::open(options.console);
  return guarded(options);
}
