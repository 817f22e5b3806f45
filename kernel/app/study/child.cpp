// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <thread>

#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel::app {
namespace {

// Owns what posix_spawn needs to send both outputs to one file.
class Redirection {
 public:
  explicit Redirection(const std::filesystem::path& log)
      : file_(::open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666)) {
    if (file_ < 0) throw OutputError("cannot write '" + log.string() + "': " + std::strerror(errno));
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, file_, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, file_, STDERR_FILENO);
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;
  ~Redirection() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::close(file_);
  }
  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  int file_;
  posix_spawn_file_actions_t actions_{};
};

// Leaves its status to be waited for.
bool ends_within(pid_t child, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  do {
    siginfo_t info{};
    if (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        info.si_pid == child)
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds);
  return false;
}

}  // namespace

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

ProgramEnd run_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                       const std::filesystem::path& log, double seconds) {
  arguments.insert(arguments.begin(), program.string());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const Redirection redirection(log);
  pid_t child = 0;
  if (const int error =
          ::posix_spawn(&child, program.c_str(), redirection.actions(), nullptr, argv.data(), environ);
      error != 0)
    throw std::system_error(error, std::generic_category(), "cannot start " + program.string());
  ProgramEnd end;
  if (std::isfinite(seconds)) end.out_of_time = !ends_within(child, seconds);
  if (end.out_of_time) ::kill(child, SIGINT);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "waiting for " + program.string());
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return end;
}

std::filesystem::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

}  // namespace shoal::kernel::app
