// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/console.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "kernel/case/diagnostics.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel::app {
namespace {

struct State {
  ConsoleSettings settings;
  bool status_line = false;
  std::string status;  // what stands on the terminal now
  std::recursive_mutex mutex;
};
State& state() {
  static State* const instance = new State;  // messages may come from destructors at exit
  return *instance;
}

void clear_status() {
  if (!state().status.empty()) std::fputs("\r\x1b[K", stderr);
}
void draw_status() {
  if (!state().status.empty()) std::fputs(state().status.c_str(), stderr);
  std::fflush(stderr);
}

void write_line(std::FILE* file, std::string_view text) {
  const std::lock_guard lock(state().mutex);
  clear_status();
  std::fwrite(text.data(), 1, text.size(), file);
  if (text.empty() || text.back() != '\n') std::fputc('\n', file);
  std::fflush(file);
  draw_status();
}

// Messages share the terminal with the status line.
class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    write_line(stderr, {text.data(), text.size()});
  }
  void flush_() override { std::fflush(stderr); }
};

spdlog::level::level_enum level_of(const std::string& name) {
  return name == "debug"   ? spdlog::level::debug
         : name == "info"  ? spdlog::level::info
         : name == "error" ? spdlog::level::err
                           : spdlog::level::warn;
}

void take_message(LogLevel level, std::string_view text) {
  if (state().settings.json && level >= LogLevel::warning) {
    Console::event(
        {{"event", level == LogLevel::warning ? "warning" : "error"}, {"message", std::string(text)}});
    return;
  }
  const auto spdlog_level = level == LogLevel::debug     ? spdlog::level::debug
                            : level == LogLevel::info    ? spdlog::level::info
                            : level == LogLevel::warning ? spdlog::level::warn
                                                         : spdlog::level::err;
  spdlog::log(spdlog_level, "{}", text);
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 10 ? size.ws_col : 80;
}

}  // namespace

void Console::open(const ConsoleSettings& settings) {
  state().settings = settings;
  state().status_line = !settings.json && !settings.quiet && ::isatty(STDERR_FILENO) != 0;
  auto logger = std::make_shared<spdlog::logger>("shoal", std::make_shared<ConsoleSink>());
  logger->set_pattern("%l: %v");
  logger->set_level(settings.quiet ? std::max(spdlog::level::err, level_of(settings.level))
                                   : level_of(settings.level));
  spdlog::set_default_logger(std::move(logger));
  set_log_sink(take_message);
}

bool Console::json() { return state().settings.json; }
bool Console::quiet() { return state().settings.quiet; }
bool Console::has_status_line() { return state().status_line; }

void Console::print(std::string_view text) {
  if (!json()) write_line(stdout, text);
}

void Console::inform(std::string_view text) {
  if (!json() && !quiet()) write_line(stdout, text);
}

void Console::event(const nlohmann::json& object) {
  if (json()) write_line(stdout, object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Console::raw(std::string_view text) { write_line(stdout, text); }

void Console::status(const std::string& line) {
  if (!has_status_line()) return;
  const std::lock_guard lock(state().mutex);
  clear_status();
  // A line that wraps could not be cleared.
  std::size_t end = line.size();
  while (end > 0 &&
         static_cast<std::size_t>(display_width(std::string_view(line).substr(0, end))) >= terminal_width())
    --end;
  state().status = line.substr(0, end);
  draw_status();
}

void Console::warning(std::string_view text) { take_message(LogLevel::warning, text); }

void Console::error(std::string_view text) {
  if (json())
    event({{"event", "error"}, {"message", std::string(text)}});
  else
    write_line(stderr, text);
}

}  // namespace shoal::kernel::app
