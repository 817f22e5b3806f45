// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Calls of the program, and cases for them.
#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace app_test {

// How much longer the program takes with sanitizers, roughly: for tests of limits of time.
#ifdef __has_feature
#define SHOAL_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define SHOAL_ADDRESS_SANITIZER 1
#endif
#if SHOAL_ADDRESS_SANITIZER
constexpr int slower = 6;
#else
constexpr int slower = 1;
#endif

inline std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A running program; its output goes to files beside the case.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), SHOAL_PROGRAM);
    for (const char* word : {"--plugin-path", SHOAL_TEST_PLUGINS}) arguments.emplace_back(word);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(::open("out", O_CREAT | O_TRUNC | O_WRONLY, 0666), STDOUT_FILENO);
      ::dup2(::open("err", O_CREAT | O_TRUNC | O_WRONLY, 0666), STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (pid_ > 0) {
      send(SIGKILL);
      wait();
    }
  }
  void send(int signal) const { ::kill(pid_, signal); }
  pid_t pid() const { return pid_; }
  bool running() {
    if (pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = 0;
    return pid_ > 0;
  }
  /// Exit code, or -signal.
  int wait() {
    if (pid_ > 0) ::waitpid(pid_, &status_, 0);
    pid_ = 0;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }

 private:
  pid_t pid_ = 0;
  int status_ = 0;
};

struct Result {
  int code;
  std::string out, err;
};

inline Result shoal(const std::vector<std::string>& arguments) {
  const int code = Process(arguments).wait();
  return {code, read("out"), read("err")};
}

/// Waits until a condition holds, at most half a minute.
template <class Condition>
bool eventually(const Condition& condition) {
  for (int k = 0; k < 3000; ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// The rows of a table of a probe; the first line is left out.
inline std::vector<std::vector<double>> rows(const std::filesystem::path& path) {
  std::vector<std::vector<double>> all;
  std::istringstream stream(read(path));
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::string cell;
    all.emplace_back();
    while (std::getline(cells, cell, ',')) all.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return all;
}

/// All fields of all particles in the newest checkpoint; before them stand wall times and counts of built lists.
inline std::string final_fields(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/checkpoints"))
    files.push_back(entry.path());
  REQUIRE_FALSE(files.empty());
  const std::string text = read(*std::max_element(files.begin(), files.end()));
  const std::size_t first_body = text.find(std::string("body\0", 5));
  REQUIRE(first_body != std::string::npos);
  return text.substr(first_body);
}

/// A pile of 20 x 10 grains above a floor; `more` are further sections.
inline std::string grains(const std::string& more, const std::string& falling = "bodies: [pile]",
                          const std::string& end = "0.1") {
  return "shoal: 1\n"
         "title: Falling grains\n"
         "plugins: [grains]\n"
         "dimensions: 2\n"
         "parameters: {dx: 0.1}\n"
         "resolution: $dx\n"
         "gravity: [0, -9.81]\n"
         "bodies:\n"
         "  pile:\n"
         "    shape: {box: {lower: [0, 0.5], upper: [2, 1.5]}}\n"
         "    material: grains.matter\n"
         "    initial: {velocity: [\"0.1 + 0.2*x\", \"0.3*y\"]}\n"
         "physics:\n"
         "  - grains.falling: {" +
         falling +
         "}\n"
         "run: {end: " +
         end + "}\n" + more;
}

}  // namespace app_test
