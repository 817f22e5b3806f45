// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the runs of a study gave, and what follows: observed orders, the Pareto front, the cheapest run for a wanted
// error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/app/study/matrix.hpp"

namespace shoal::kernel::app {

struct StudyError {
  std::string probe, column, measure;  ///< column: empty for the probe's first
  double error = 0.0;                  ///< NaN where the run has none
  double tolerance = 0.0;
};

struct StudyResult {
  StudyRun run;
  std::string status;        ///< finished, failed, ... as in summary.json; "no result" without one;
                             ///< "stopped at 35 %" or "left out" where no wall time was left
  std::string why;           ///< of a run that did not finish
  double reached = 0.0;      ///< share of the simulated time
  bool out_of_time = false;  ///< it was stopped, or not begun, since no wall time was left
  double spacing = 0.0;      ///< smallest of all bodies that move (or of all, if none does), m
  std::uint64_t particles = 0, outer_steps = 0, peak_memory = 0;
  double bytes_per_particle = 0.0;
  double wall_seconds = 0.0;  ///< of all sessions of the run
  double particle_steps_per_second = 0.0;
  double pairs_per_second =
      0.0;  ///< of the sum over pairs that took longest, on all threads; NaN without one
  std::vector<StudyError> errors;  ///< one for each reference of the case

  bool finished() const { return status == "finished"; }
};

/// From the run's folder.
StudyResult read_result(const StudyRun& run, const std::filesystem::path& folder);

/// log(e1 / e2) / log(h1 / h2) of error number `error` against the run of the next larger spacing among those that
/// agree in all other variations; nothing where there is none. `refined`: the variation that changes the spacing.
std::vector<std::optional<double>> observed_orders(const std::vector<StudyResult>& results, std::size_t error,
                                                   std::optional<std::size_t> refined);

/// The first variation of which a change alone changes the spacing.
std::optional<std::size_t> refined_variation(const std::vector<StudyResult>& results,
                                             std::size_t n_variations);

/// Whether no other finished run has both a smaller error and a smaller wall time.
std::vector<bool> pareto_front(const std::vector<StudyResult>& results, std::size_t error);

/// The run of least wall time with an error of at most `wanted`.
std::optional<std::size_t> cheapest(const std::vector<StudyResult>& results, std::size_t error,
                                    double wanted);

}  // namespace shoal::kernel::app
