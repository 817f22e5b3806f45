// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/result_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel {
namespace {

// Marks a folder of results from the first moment, and keeps two runs from writing to the same.
std::filesystem::path lock_file(const std::filesystem::path& folder) { return folder / ".shoal"; }

bool is_file(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

// Nothing, or what is left of a run that was killed before its first results.
bool holds_nothing(const std::filesystem::path& folder) {
  std::error_code none;
  if (is_file(lock_file(folder)) && !is_file(folder / "summary.json")) return true;
  return std::filesystem::is_empty(folder, none);
}

// Copies may have lost the mark.
bool is_results(const std::filesystem::path& folder) {
  return is_file(lock_file(folder)) || (is_file(folder / "case.yaml") && is_file(folder / "summary.json"));
}

std::filesystem::path free_sibling(const std::filesystem::path& folder) {
  for (int k = 1;; ++k) {
    std::filesystem::path aside = folder;
    aside += ".replaced-" + std::to_string(k);
    if (!std::filesystem::exists(aside)) return aside;
  }
}

// "results/" and "results" are the same folder, but only the latter has siblings.
std::filesystem::path normal(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

ResultFolder::ResultFolder(std::filesystem::path path) : path_(std::move(path)) {
  lock_ = ::open(lock_file(path_).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock_);
    throw FolderError("another run is writing to '" + path_.string() + "'");
  }
}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : path_(std::move(other.path_)),
      replaced_(std::move(other.replaced_)),
      lock_(std::exchange(other.lock_, -1)) {}

ResultFolder::~ResultFolder() {
  if (lock_ >= 0) ::close(lock_);
}

void ResultFolder::check_free(const std::filesystem::path& folder, bool replace) {
  const std::filesystem::path path = normal(folder);
  if (!std::filesystem::exists(path)) return;
  if (!std::filesystem::is_directory(path))
    throw FolderError("'" + path.string() + "' is a file; results need a folder (--output FOLDER)");
  if (is_file(lock_file(path))) const ResultFolder probe(path);  // not while another run writes there
  if (holds_nothing(path)) return;
  if (!is_results(path))
    throw FolderError("'" + path.string() +
                      "' exists and holds something else than results of Shoal; choose another " +
                      "folder with --output FOLDER");
  if (!replace)
    throw FolderError("'" + path.string() +
                      "' holds results already; replace them with --force, write elsewhere with " +
                      "--output FOLDER, or go on with them: shoal resume " + path.string());
}

ResultFolder ResultFolder::make(const std::filesystem::path& folder, bool replace) {
  check_free(folder, replace);
  const std::filesystem::path path = normal(folder);
  std::filesystem::path aside;
  if (std::filesystem::exists(path) && !std::filesystem::is_empty(path)) {
    aside = free_sibling(path);
    std::error_code error;
    std::filesystem::rename(path, aside, error);
    if (error) throw FolderError("cannot put '" + path.string() + "' aside: " + error.message());
  }
  make_folder(path);
  ResultFolder result(path);
  result.replaced_ = std::move(aside);
  return result;
}

void ResultFolder::remove_replaced() {
  std::error_code ignored;
  if (!replaced_.empty()) std::filesystem::remove_all(replaced_, ignored);
  replaced_.clear();
}

ResultFolder ResultFolder::reopen(const std::filesystem::path& folder) {
  const std::filesystem::path path = normal(folder);
  if (!std::filesystem::is_directory(path)) throw FolderError("there is no folder '" + path.string() + "'");
  if (!std::filesystem::is_regular_file(path / "case.yaml"))
    throw FolderError("'" + path.string() + "' is no folder of results: it has no case.yaml");
  return ResultFolder(path);
}

void ResultFolder::write_case(const std::string& text) const { write_atomically(case_file(), text); }
void ResultFolder::write_summary(const std::string& text) const { write_atomically(summary_file(), text); }

}  // namespace shoal::kernel
