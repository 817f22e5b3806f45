// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of one case with other settings, each in a process and a folder of its own. What has results is not run again,
// and what was stopped goes on.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kernel/app/options.hpp"
#include "kernel/app/study/result.hpp"

namespace shoal::kernel::app {

struct RunRequest {
  StudyRun run;
  std::vector<std::string> settings;  ///< KEY=VALUE, all of them
  std::filesystem::path folder;       ///< for its results; FOLDER.key and FOLDER.log stand beside it
  std::string label;                  ///< before the run's name in messages: "2/6  "
};

class CaseRunner {
 public:
  /// `budget`: wall time of all runs together, in s, of those that are taken as they are too.
  CaseRunner(const Options& options, std::string text_of_case,
             double budget = std::numeric_limits<double>::infinity());

  /// Throws UserError if the folder holds results of something else.
  StudyResult run(const RunRequest& request);

 private:
  std::string key_of(const RunRequest& request) const;
  std::vector<std::string> arguments(const RunRequest& request, bool resumes) const;
  StudyResult note(const RunRequest& request, int code, bool out_of_time);
  double left() const { return budget_ - spent_; }

  const Options& options_;
  std::string text_of_case_;
  double budget_, spent_ = 0.0;
};

/// --within; infinite without it. Throws UserError.
double read_budget(const Options& options);

}  // namespace shoal::kernel::app
