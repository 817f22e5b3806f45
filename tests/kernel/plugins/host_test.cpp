// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The host table, and the calls of callbacks, with callbacks of this file in place of a plugin's.
#include "kernel/plugins/host.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <thread>
#include <vector>

using namespace shoal::kernel;

namespace {

template <class Callback>
PluginFailure failure_of(Callback callback) {
  try {
    call_plugin("fluid", "fluid.viscous_force", callback);
  } catch (const PluginFailure& failure) {
    return failure;
  }
  FAIL("did not fail");
  throw;
}

}  // namespace

TEST_CASE("the host table says what it is") {
  const shoal_host& host = plugin_host();
  CHECK(host.size == sizeof(shoal_host));
  CHECK(host.abi_major == SHOAL_ABI_MAJOR);
  CHECK(host.abi_minor == SHOAL_ABI_MINOR);
  CHECK(std::string(host.version).find('.') != std::string::npos);
  CHECK(&plugin_host() == &host);
}

TEST_CASE("a status becomes an exception with the plugin's words") {
  CHECK_NOTHROW(call_plugin("fluid", "", [] { return SHOAL_OK; }));
  CHECK_NOTHROW(call_plugin("fluid", "", [] {}));
  const PluginFailure failure = failure_of([] {
    plugin_host().fail("density fell below zero");
    return SHOAL_PHYSICS_FAILED;
  });
  CHECK(std::string(failure.what()) == "fluid.viscous_force: density fell below zero");
  CHECK(failure.plugin() == "fluid");
  CHECK(failure.type() == "fluid.viscous_force");
  CHECK(failure.text() == "density fell below zero");
  CHECK(failure.status() == SHOAL_PHYSICS_FAILED);
  CHECK(failure_of([] { return SHOAL_CASE_ERROR; }).status() == SHOAL_CASE_ERROR);
}

TEST_CASE("words of an earlier call are not those of this one") {
  call_plugin("fluid", "", [] {
    plugin_host().fail("said, but not meant");
    return SHOAL_OK;
  });
  CHECK(failure_of([] { return SHOAL_ERROR; }).text() ==
        "it failed without saying why (a plugin says why through host->fail)");
  plugin_host().fail("first");
  plugin_host().fail("second");
  CHECK(take_failure_text() == "second");
  CHECK(take_failure_text().empty());
  plugin_host().fail(nullptr);
  CHECK(take_failure_text().empty());
}

TEST_CASE("statuses that do not exist, and exceptions that must not be") {
  const PluginFailure odd = failure_of([] { return 17; });
  CHECK(odd.status() == SHOAL_ERROR);
  CHECK(odd.text() == "it returned the unknown status 17");
  const PluginFailure thrown = failure_of([]() -> shoal_status { throw std::runtime_error("unplanned"); });
  CHECK(thrown.text() == "an exception left the plugin, which its callbacks must not let happen: unplanned");
  const PluginFailure strange = failure_of([]() -> shoal_status { throw 7; });
  CHECK(
      strange.text() ==
      "an exception left the plugin, which its callbacks must not let happen: an exception of unknown type");
}

TEST_CASE("each thread has its own words") {
  std::vector<std::string> texts(8);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < texts.size(); ++k)
    threads.emplace_back([&texts, k] {
      const std::string mine = "worker " + std::to_string(k);
      for (int n = 0; n < 1000; ++n) {
        try {
          call_plugin("fluid", "fluid.force", [&] {
            plugin_host().fail(mine.c_str());
            return SHOAL_ERROR;
          });
        } catch (const PluginFailure& failure) {
          texts[k] = failure.text();
          if (texts[k] != mine) return;
        }
      }
    });
  for (auto& thread : threads) thread.join();
  for (std::size_t k = 0; k < texts.size(); ++k) CHECK(texts[k] == "worker " + std::to_string(k));
}

TEST_CASE("why a run is to end is told once, whoever said it") {
  CHECK(take_finish_reason().empty());
  std::thread([] { plugin_host().finish("it has come to rest"); }).join();
  CHECK(take_finish_reason() == "it has come to rest");
  CHECK(take_finish_reason().empty());
  plugin_host().finish(nullptr);
  CHECK(take_finish_reason() == "a plugin asked for it");
}

TEST_CASE("messages reach the sink, one at a time, from any thread") {
  std::vector<std::pair<LogLevel, std::string>> messages;
  set_log_sink([&](LogLevel level, std::string_view text) { messages.emplace_back(level, text); });
  plugin_host().log(SHOAL_LOG_WARNING, "careful");
  plugin_host().log(77, "an unknown level is the gravest");
  plugin_host().log(SHOAL_LOG_INFO, nullptr);
  log(LogLevel::debug, "of the kernel");
  REQUIRE(messages.size() == 3);
  CHECK(messages[0] == std::pair(LogLevel::warning, std::string("careful")));
  CHECK(messages[1].first == LogLevel::error);
  CHECK(messages[2] == std::pair(LogLevel::debug, std::string("of the kernel")));
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([] {
      for (int n = 0; n < 500; ++n) plugin_host().log(SHOAL_LOG_INFO, "busy");
    });
  for (auto& thread : threads) thread.join();
  CHECK(messages.size() == 2003);
  set_log_sink([](LogLevel, std::string_view) { throw std::runtime_error("disk full"); });
  plugin_host().log(SHOAL_LOG_INFO, "lost, but nothing is thrown into the plugin");
  set_log_sink({});
  plugin_host().log(SHOAL_LOG_INFO, "dropped");
}

TEST_CASE("expressions are evaluated by whoever can") {
  const auto* expression = reinterpret_cast<const shoal_expression*>(&plugin_host());
  const double point[2] = {1.0, 2.0};
  double out = 0.0;
  CHECK(plugin_host().evaluate(expression, 2, 1, point, 0.0, &out) == SHOAL_ERROR);
  CHECK(take_failure_text() == "expressions cannot be evaluated before the case is read");
  set_evaluate(
      [](const shoal_expression*, int32_t, uint64_t, const double* position, double t, double* result) {
        *result = position[0] + position[1] + t;
        return SHOAL_OK;
      });
  CHECK(plugin_host().evaluate(expression, 2, 1, point, 0.5, &out) == SHOAL_OK);
  CHECK(out == 3.5);
  CHECK(plugin_host().evaluate(nullptr, 2, 1, point, 0.5, &out) == SHOAL_ERROR);
  CHECK(take_failure_text() == "an expression that is not set was evaluated");
  set_evaluate([](const shoal_expression*, int32_t, uint64_t, const double*, double,
                  double*) -> shoal_status { throw std::runtime_error("division by zero"); });
  CHECK(plugin_host().evaluate(expression, 2, 1, point, 0.5, &out) == SHOAL_ERROR);
  CHECK(take_failure_text() == "division by zero");
  set_evaluate(nullptr);
}

TEST_CASE("expressions of a plugin's own names are evaluated by whoever can") {
  const auto* expression = reinterpret_cast<const shoal_expression*>(&plugin_host());
  const double point[2] = {1.0, 2.0}, value = 5.0;
  const double* columns[1] = {&value};
  double out = 0.0;
  CHECK(plugin_host().expression_name(expression, 0) == nullptr);
  CHECK(plugin_host().evaluate_names(expression, 2, 1, point, columns, 0.0, &out) == SHOAL_ERROR);
  CHECK(take_failure_text() == "expressions cannot be evaluated before the case is read");
  set_names([](const shoal_expression*, uint32_t k) { return k == 0 ? "u" : nullptr; },
            [](const shoal_expression*, int32_t, uint64_t, const double* position,
               const double* const* column, double t, double* result) {
              *result = position[0] + column[0][0] + t;
              return SHOAL_OK;
            });
  CHECK(std::string(plugin_host().expression_name(expression, 0)) == "u");
  CHECK(plugin_host().expression_name(expression, 1) == nullptr);
  CHECK(plugin_host().expression_name(nullptr, 0) == nullptr);
  CHECK(plugin_host().evaluate_names(expression, 2, 1, point, columns, 0.5, &out) == SHOAL_OK);
  CHECK(out == 6.5);
  set_names(nullptr, nullptr);
}
