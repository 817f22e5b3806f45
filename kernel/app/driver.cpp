// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "kernel/app/console.hpp"
#include "kernel/app/exit_code.hpp"
#include "kernel/app/interrupt.hpp"
#include "kernel/app/progress.hpp"
#include "kernel/app/report.hpp"
#include "kernel/app/text.hpp"
#include "kernel/build_info.hpp"
#include "kernel/case/effective.hpp"
#include "kernel/output/atomic_file.hpp"
#include "kernel/plugins/errors.hpp"

namespace shoal::kernel::app {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::localtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &parts)};
}

int threads_of(const Options& options) {
  return options.threads > 0 ? options.threads
                             : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

// What ParaView can open, whoever wrote it.
std::vector<std::string> time_series(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& output : std::filesystem::directory_iterator(folder, none))
    for (const auto& file : std::filesystem::directory_iterator(output.path(), none))
      if (file.path().extension() == ".pvd") files.push_back(file.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Driver::Driver(const Options& options, Session& session, ResultFolder folder, Clock::time_point begin)
    : options_(options),
      session_(session),
      folder_(std::move(folder)),
      checkpoints_(folder_.checkpoints()),
      effective_case_(effective_case(session.model())),
      started_(local_time()),
      begin_(begin),
      last_checkpoint_(Clock::now()),
      checkpoint_due_(session.model().run.checkpoint_every, {}) {
  if (options.until) until_ = read_time("--until", *options.until);
  checkpoint_every_ =
      options.checkpoint_every.empty() ? 1800.0 : read_time("--checkpoint-every", options.checkpoint_every);
  // Longer than the case says: then the end is where the user wants it.
  if (until_ && *until_ > session.run().end_time()) session.run().set_end_time(*until_);
}

double Driver::wall_seconds() const { return seconds_since(begin_); }

void Driver::start() {
  folder_.write_case(effective_case_);
  folder_.write_summary(to_json(summary("running")));
  session_.recorder().open(folder_.path());
  session_.run().initialise();
  session_.recorder().start(session_.run());
  folder_.remove_replaced();
  tell_start("run");
}

void Driver::resume() {
  const std::vector<std::filesystem::path> candidates = checkpoints_.newest_first();
  if (candidates.empty())
    throw UserError(option_place(folder_.path().string()),
                    "it has no checkpoint to go on from; run its case.yaml again into another folder");
  for (const std::filesystem::path& candidate : candidates) {
    if (!load(candidate)) continue;
    checkpoints_.remove_newer_than(candidate);
    // The file of the first session says where each value came from; it stays if it is still true.
    if (!differences(read_whole_file(folder_.case_file()), effective_case_).empty())
      folder_.write_case(effective_case_);
    folder_.write_summary(to_json(summary("running")));
    tell_start("resume");
    return;
  }
  throw CheckpointError("none of the checkpoints in '" + folder_.checkpoints().string() + "' can be read");
}

bool Driver::load(const std::filesystem::path& checkpoint) {
  RunState state;
  try {
    CheckpointStore::read(checkpoint, [&](const std::string& header, std::istream& body) {
      state = state_from_text(header);
      check_same_physics(state);
      session_.run().load(body);
    });
  } catch (const CheckpointError& error) {
    Console::warning(std::string(error.what()) + "; trying the one before");
    return false;
  }
  // Somebody who names a later time wants to go on.
  const bool goes_on = until_ && *until_ > session_.run().time();
  session_.run().set_finish_reason(goes_on ? std::string() : state.finish_reason);
  earlier_wall_seconds_ = state.wall_seconds;
  start_time_ = last_time_ = session_.run().time();
  first_step_ = checkpointed_step_ = session_.run().outer_steps();
  session_.recorder().open(folder_.path(), state.recorder);
  session_.recorder().go_on(session_.run());
  return true;
}

void Driver::check_same_physics(const RunState& state) const {
  const std::vector<std::string> lines = differing_physics(state.effective_case, effective_case_);
  if (lines.empty()) return;
  if (options_.force) {
    for (const std::string& line : lines) Console::warning("changed since the checkpoint: " + line);
    return;
  }
  std::vector<std::string> notes = lines;
  notes.emplace_back("run the case anew, or insist with --force");
  throw UserError(option_place(session_.file().name()),
                  "the case is another computation than the one that the checkpoint is of", notes);
}

void Driver::tell_start(const std::string& how) const {
  const Simulation& run = session_.run();
  if (Console::json()) {
    Console::event({{"event", "start"},
                    {"how", how},
                    {"title", session_.model().title},
                    {"folder", folder_.path().string()},
                    {"particles", run.n_particles()},
                    {"threads", threads_of(options_)},
                    {"time", run.time()},
                    {"end", run.end_time()}});
    return;
  }
  const std::string& title = session_.model().title;
  Console::inform(title.empty() ? case_name(session_.model().name) : title);
  Console::inform(bodies_text(run.plan()) +
                  fmt::format("  {} to {} on {} thread{}, results in {}", simulated_time_text(run.time()),
                              simulated_time_text(run.end_time()), threads_of(options_),
                              threads_of(options_) == 1 ? "" : "s", folder_.path().string()));
}

bool Driver::stop_asked() const {
  const Simulation& run = session_.run();
  if (until_ && run.time() >= *until_ * (1.0 - 1e-12)) return true;
  return options_.steps && run.outer_steps() - first_step_ >= *options_.steps;
}

void Driver::step() {
  Simulation& run = session_.run();
  run.step();
  session_.recorder().after_step(run);
  checkpoint_if_due();
  last_time_ = run.time();
}

void Driver::checkpoint_if_due() {
  const bool by_time = checkpoint_due_.between(last_time_, session_.run().time());
  const bool by_clock = checkpoint_every_ > 0.0 && seconds_since(last_checkpoint_) >= checkpoint_every_;
  if (!by_time && !by_clock) return;
  try {
    write_checkpoint();
  } catch (const OutputError& error) {
    // A full disk may have room again before the next one; the run itself is well.
    last_checkpoint_ = Clock::now();
    Console::warning(std::string("no checkpoint was written: ") + error.what());
  }
}

void Driver::write_checkpoint() {
  Simulation& run = session_.run();
  if (checkpointed_step_ == run.outer_steps()) return;
  const Clock::time_point begin = Clock::now();
  const RunState state{
      std::string(build_info::version),       effective_case_,     run.time(),
      earlier_wall_seconds_ + wall_seconds(), run.finish_reason(), session_.recorder().state()};
  checkpoints_.write(run.outer_steps(), to_text(state), [&](std::ostream& stream) { run.save(stream); });
  checkpointed_step_ = run.outer_steps();
  last_checkpoint_ = Clock::now();
  checkpoint_seconds_ += seconds_since(begin);
}

int Driver::drive() {
  Simulation& run = session_.run();
  startup_seconds_ = wall_seconds();
  Progress progress(run);
  try {
    while (!run.finished() && !interrupted() && !stop_asked()) {
      step();
      progress.step(run);
    }
  } catch (const PhysicsFailure& failure) {
    progress.end();
    return fail(failure);
  } catch (const std::exception& error) {
    progress.end();
    record_failure(error.what());
    throw;
  }
  progress.end();
  write_checkpoint();
  return finish(run.finished() ? "finished" : interrupted() ? "interrupted" : "stopped");
}

// The summary of a run that ends by an exception; that it cannot be written must not hide why.
void Driver::record_failure(const std::string& why) const {
  try {
    Summary result = summary("failed");
    result.failure = why;
    folder_.write_summary(to_json(result));
  } catch (const std::exception& error) {
    Console::warning(error.what());
  }
}

int Driver::finish(const std::string& status) {
  const Summary result = summary(status);
  folder_.write_summary(to_json(result));
  tell_end(result);
  if (status == "interrupted") return exit_interrupted;
  bool failed = false;
  for (const ReferenceResult& reference : result.references)
    failed = failed || reference.verdict == Verdict::fail;
  return failed && options_.strict ? exit_physics_failed : exit_done;
}

int Driver::fail(const PhysicsFailure& failure) {
  const Simulation& run = session_.run();
  record_failure(failure.report().cause);
  std::string text = failure_text(failure.report());
  try {
    session_.recorder().dump(run, folder_.failure());
    text += "  all particles as they were then: " + folder_.failure().string() + "\n";
  } catch (const std::exception& error) {
    text += std::string("  the particles could not be written: ") + error.what() + "\n";
  }
  if (!checkpoints_.newest_first().empty())
    text += "  go on from the last checkpoint with: shoal resume " + folder_.path().string() + "\n";
  Console::error(text);
  Console::event(
      {{"event", "end"}, {"status", "failed"}, {"cause", failure.report().cause}, {"time", run.time()}});
  return exit_physics_failed;
}

Summary Driver::summary(const std::string& status) const {
  Simulation& run = session_.run();
  Summary s;
  s.title = session_.model().title;
  s.case_file = session_.model().name;
  s.folder = folder_.path().string();
  s.version = build_info::version;
  s.compiler = build_info::compiler;
  s.build_type = build_info::build_type;
  s.flags = build_info::flags;
  for (const LoadedPlugin* plugin : session_.workshop().loader.loaded())
    s.plugins.push_back({plugin->id, plugin->version_text, plugin->path.string()});
  s.dimensions = session_.model().dimensions;
  s.threads = threads_of(options_);
  s.started = started_;
  s.status = status;
  s.finish_reason = run.finish_reason();
  s.time = run.time();
  s.start_time = start_time_;
  s.end_time = run.end_time();
  s.outer_steps = run.outer_steps();
  s.wall_seconds = wall_seconds();
  s.earlier_wall_seconds = earlier_wall_seconds_;
  s.startup_seconds = startup_seconds_;
  s.output_seconds = session_.recorder().seconds();
  s.checkpoint_seconds = checkpoint_seconds_;
  s.peak_memory = peak_memory();
  s.plan = run.plan();
  s.timings = run.timings();
  if (status != "running") s.references = session_.recorder().compare_references(run.finished());
  return s;
}

void Driver::tell_end(const Summary& result) const {
  const std::string folder = folder_.path().string();
  if (Console::json()) {
    nlohmann::json event = nlohmann::json::parse(to_json(result));
    event["event"] = "end";
    Console::event(event);
    return;
  }
  Console::inform("\n" + timings_text(result));
  if (!result.references.empty()) Console::print(references_text(result.references));
  const std::string wall = duration_text(result.wall_seconds);
  if (result.status == "finished" && !result.finish_reason.empty())
    Console::print(fmt::format("ended at {}: {}", simulated_time_text(result.time), result.finish_reason));
  if (const std::vector<std::string> files = time_series(folder_.path()); !files.empty())
    Console::inform("for ParaView: " + join(files));
  if (result.status == "finished")
    Console::inform(fmt::format("done in {}; results in {}", wall, folder));
  else
    Console::print(fmt::format("{} at {} after {}; go on with: shoal resume {}", result.status,
                               simulated_time_text(result.time), wall, folder));
}

}  // namespace shoal::kernel::app
