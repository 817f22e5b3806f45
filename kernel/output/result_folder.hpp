// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The folder of a run's results:
//
//   case.yaml       the effective case        summary.json   what was computed, at what cost, how well
//   probes/*.csv    tables of the probes      checkpoints/   the last two
//   vtk/ ...        one folder per output     failure/       all particles, if the physics failed
//
// Results are never lost by mistake: an existing folder is replaced only when asked, only if it is one of these, and
// only when the new run has been checked and built.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace shoal::kernel {

/// The folder cannot be used as asked; what() says what to do.
class FolderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ResultFolder {
 public:
  /// Whether a new run could be written there: to be asked before anything expensive. Throws FolderError.
  static void check_free(const std::filesystem::path& folder, bool replace);

  /// Takes the folder for a new run; earlier results are put aside. Throws FolderError, OutputError.
  static ResultFolder make(const std::filesystem::path& folder, bool replace);
  /// Takes the folder of an earlier run to go on with it. Throws FolderError.
  static ResultFolder reopen(const std::filesystem::path& folder);

  ResultFolder(ResultFolder&& other) noexcept;
  ResultFolder& operator=(ResultFolder&&) = delete;
  ~ResultFolder();

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path case_file() const { return path_ / "case.yaml"; }
  std::filesystem::path summary_file() const { return path_ / "summary.json"; }
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path failure() const { return path_ / "failure"; }

  /// Removes what was put aside: once the new run has begun.
  void remove_replaced();

  void write_case(const std::string& text) const;
  void write_summary(const std::string& text) const;

 private:
  explicit ResultFolder(std::filesystem::path path);
  std::filesystem::path path_, replaced_;
  int lock_ = -1;
};

}  // namespace shoal::kernel
