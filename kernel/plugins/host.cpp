// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The host table. Its functions have C signatures without a context, hence the state of this file.
#include "kernel/plugins/host.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "kernel/build_info.hpp"
#include "kernel/plugins/isa.hpp"

namespace shoal::kernel {
namespace {

struct Sink {
  std::mutex mutex;
  LogSink function;
};
// Never destroyed: a plugin's static destructors may log after ours have run.
Sink& sink() {
  static Sink* const instance = new Sink;
  return *instance;
}

std::atomic<EvaluateFunction> evaluate_function{nullptr};
std::atomic<EvaluateNamesFunction> evaluate_names_function{nullptr};
std::atomic<NameFunction> name_function{nullptr};

// Why the run is to end, by whatever thread it was said.
struct Finish {
  std::mutex mutex;
  std::atomic<bool> asked{false};
  std::string reason;
};
Finish& the_finish() {
  static Finish instance;
  return instance;
}

void host_finish(const char* reason) {
  Finish& finish = the_finish();
  const std::lock_guard lock(finish.mutex);
  try {
    finish.reason = reason && *reason ? reason : "a plugin asked for it";
  } catch (...) {
    finish.reason.clear();
  }
  finish.asked = true;
}

// A flag beside the text keeps the call of a callback that does not fail free of string work.
thread_local bool has_failure = false;
thread_local std::string failure_text;

void host_log(uint32_t level, const char* text) {
  if (!text) return;
  log(static_cast<LogLevel>(std::min<uint32_t>(level, SHOAL_LOG_ERROR)), text);
}

void host_fail(const char* text) {
  try {
    failure_text = text ? text : "";
  } catch (...) {
    failure_text.clear();  // out of memory: the status alone must do
  }
  has_failure = true;
}

// Calls a function of whoever can evaluate.
template <class Function, class Call>
shoal_status evaluated(const shoal_expression* expression, Function function, Call&& call) {
  if (!function || !expression) {
    host_fail(function ? "an expression that is not set was evaluated"
                       : "expressions cannot be evaluated before the case is read");
    return SHOAL_ERROR;
  }
  try {
    return call(function);
  } catch (const std::exception& error) {
    host_fail(error.what());
  } catch (...) {
    host_fail("an expression could not be evaluated");
  }
  return SHOAL_ERROR;
}

shoal_status host_evaluate(const shoal_expression* expression, int32_t dimensions, uint64_t n,
                           const double* position, double t, double* out) {
  return evaluated(expression, evaluate_function.load(std::memory_order_acquire),
                   [&](auto evaluate) { return evaluate(expression, dimensions, n, position, t, out); });
}

shoal_status host_evaluate_names(const shoal_expression* expression, int32_t dimensions, uint64_t n,
                                 const double* position, const double* const* columns, double t,
                                 double* out) {
  return evaluated(expression, evaluate_names_function.load(std::memory_order_acquire), [&](auto evaluate) {
    return evaluate(expression, dimensions, n, position, columns, t, out);
  });
}

const char* host_expression_name(const shoal_expression* expression, uint32_t k) {
  const NameFunction name = name_function.load(std::memory_order_acquire);
  return name && expression ? name(expression, k) : nullptr;
}

}  // namespace

void set_log_sink(LogSink new_sink) {
  const std::lock_guard lock(sink().mutex);
  sink().function = std::move(new_sink);
}

void log(LogLevel level, std::string_view text) {
  try {
    const std::lock_guard lock(sink().mutex);
    if (sink().function) sink().function(level, text);
  } catch (...) {
    // A log that cannot be written must not stop a run, and nothing may be thrown into a plugin.
  }
}

void set_evaluate(EvaluateFunction evaluate) { evaluate_function.store(evaluate, std::memory_order_release); }
void set_names(NameFunction name, EvaluateNamesFunction evaluate) {
  name_function.store(name, std::memory_order_release);
  evaluate_names_function.store(evaluate, std::memory_order_release);
}

const shoal_host& plugin_host() {
  static const std::string version(build_info::version);
  static const shoal_host table{.size = sizeof(shoal_host),
                                .abi_major = SHOAL_ABI_MAJOR,
                                .abi_minor = SHOAL_ABI_MINOR,
                                .isa = isa_of_machine(),
                                .version = version.c_str(),
                                .log = host_log,
                                .fail = host_fail,
                                .evaluate = host_evaluate,
                                .expression_name = host_expression_name,
                                .evaluate_names = host_evaluate_names,
                                .finish = host_finish};
  return table;
}

std::string take_failure_text() {
  std::string text;
  if (has_failure) text.swap(failure_text);
  has_failure = false;
  return text;
}

std::string take_finish_reason() {
  Finish& finish = the_finish();
  if (!finish.asked.load(std::memory_order_relaxed)) return {};
  const std::lock_guard lock(finish.mutex);
  finish.asked = false;
  return std::exchange(finish.reason, {});
}

namespace detail {

void forget_failure_text() noexcept { has_failure = false; }

void throw_plugin_failure(std::string_view plugin, std::string_view type, int status, const char* thrown) {
  std::string text = take_failure_text();
  if (thrown)
    text = std::string("an exception left the plugin, which its callbacks must not let happen: ") + thrown;
  if (status < SHOAL_OK || status > SHOAL_PHYSICS_FAILED) {
    text += (text.empty() ? "it returned the unknown status " : "; it returned the unknown status ") +
            std::to_string(status);
    status = SHOAL_ERROR;
  }
  if (text.empty()) text = "it failed without saying why (a plugin says why through host->fail)";
  throw PluginFailure(std::string(plugin), std::string(type), static_cast<shoal_status>(status),
                      std::move(text));
}

}  // namespace detail
}  // namespace shoal::kernel
