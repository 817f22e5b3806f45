// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernel as plugins see it (shoal_host), and the way every callback of a plugin is called.
// What the kernel's other parts bring (a log, expressions) is set here, so that this folder depends on none
// of them.
#pragma once

#include <exception>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "kernel/plugins/errors.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

enum class LogLevel { debug = 0, info = 1, warning = 2, error = 3 };

/// Takes the messages of plugins and kernel; called from any thread, one call at a time. Without a sink
/// messages are dropped: the kernel does not print. Must not log itself.
using LogSink = std::function<void(LogLevel, std::string_view)>;
void set_log_sink(LogSink sink);

/// A message of the kernel's own, to the same sink. [any thread]
void log(LogLevel level, std::string_view text);

/// Has the signature of shoal_host::evaluate; may throw. Set once, before plugins are asked to build.
using EvaluateFunction = shoal_status (*)(const shoal_expression* expression, int32_t dimensions, uint64_t n,
                                          const double* position, double t, double* out);
void set_evaluate(EvaluateFunction evaluate);
/// The same for shoal_host::expression_name and evaluate_names.
using NameFunction = const char* (*)(const shoal_expression* expression, uint32_t k);
using EvaluateNamesFunction = shoal_status (*)(const shoal_expression* expression, int32_t dimensions,
                                               uint64_t n, const double* position,
                                               const double* const* columns, double t, double* out);
void set_names(NameFunction name, EvaluateNamesFunction evaluate);

/// The one host table of this process.
const shoal_host& plugin_host();

/// What a plugin last said through host->fail on this thread; forgotten by this call.
std::string take_failure_text();
/// Why a plugin wants the run to end since the last call (shoal_host::finish); empty if none does.
std::string take_finish_reason();

namespace detail {
void forget_failure_text() noexcept;
[[noreturn]] void throw_plugin_failure(std::string_view plugin, std::string_view type, int status,
                                       const char* thrown);
}  // namespace detail

/// Calls a callback that returns a shoal_status, or nothing, on this thread; throws PluginFailure if it
/// fails, and also for an exception that the plugin lets escape against the rules. `plugin` is its id, `type`
/// the name of its type; both are used on failure only.
template <class Call>
void call_plugin(std::string_view plugin, std::string_view type, Call&& call) {
  int status = SHOAL_OK;  // not the enumeration: a plugin may return what is none of its values
  detail::forget_failure_text();
  try {
    if constexpr (std::is_void_v<decltype(call())>)
      std::forward<Call>(call)();
    else
      status = static_cast<int>(std::forward<Call>(call)());
  } catch (const std::exception& error) {
    detail::throw_plugin_failure(plugin, type, SHOAL_ERROR, error.what());
  } catch (...) {
    detail::throw_plugin_failure(plugin, type, SHOAL_ERROR, "an exception of unknown type");
  }
  if (status != SHOAL_OK) detail::throw_plugin_failure(plugin, type, status, nullptr);
}

}  // namespace shoal::kernel
