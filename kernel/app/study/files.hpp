// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a study leaves behind: a table for people, study.csv for machines, and pictures of error against spacing and
// against wall time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/app/study/result.hpp"

namespace shoal::kernel::app {

struct Study {
  std::string title;
  std::vector<Variation> variations;
  std::vector<StudyResult> results;
  std::optional<std::size_t> refined;  ///< the variation that changes the spacing
  std::size_t chosen = 0;              ///< the error that the front and the pictures are of
};

/// Names of the references: "wall_pressure rms".
std::vector<std::string> error_names(const Study& study);

std::string study_table(const Study& study);
std::string study_csv(const Study& study);

/// A value as it stands in a file of comma-separated values.
std::string csv_cell(std::string text);
std::string csv_number(double value);  ///< empty where it is none

/// A script of gnuplot that draws error_against_spacing, if spacings differ, and error_against_time (.svg and .png) in its
/// own folder; empty if no run has the chosen error.
std::string study_plot(const Study& study);

}  // namespace shoal::kernel::app
