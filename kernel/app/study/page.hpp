// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The pages of a report, from studies that have run: Markdown with pictures beside it, and one HTML page that holds
// everything. Nothing in them is written by hand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::kernel::app {

/// What a page says of one case.
struct CaseReport {
  std::string area, name, title;
  std::string what;                                           ///< the comment at the head of the case
  std::filesystem::path case_file;                            ///< as it was given
  std::string plugins;                                        ///< of the plan: "fluid 0.1.0 vtk 0.1.0"
  std::string plan;                                           ///< the text of shoal plan
  std::vector<std::vector<std::string>> table;                ///< study.csv; its first row names the columns
  std::vector<std::vector<std::string>> means;                ///< ensemble.csv, if the case has an ensemble
  std::vector<std::vector<std::string>> limits;               ///< limits.csv, if they were looked for
  std::vector<std::pair<std::string, std::string>> pictures;  ///< name and SVG
  std::string failure;                                        ///< why there is no table
};

struct MachineReport {
  std::string processor, date, version, within;  ///< within: wall time for each case; empty: any
  unsigned cores = 0;
  int threads = 0;
};

std::string markdown_page(const MachineReport& machine, const std::vector<CaseReport>& cases);
std::string html_page(const MachineReport& machine, const std::vector<CaseReport>& cases);

/// File of a picture beside the Markdown page: "fluid_couette_error_against_time.svg".
std::string picture_file(const CaseReport& report, const std::string& picture);

}  // namespace shoal::kernel::app
