// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/ensemble.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernel/app/study/files.hpp"
#include "kernel/app/text.hpp"

namespace shoal::kernel::app {
std::string ensemble_table(const std::vector<std::string>& keys, const std::vector<EnsembleMean>& means) {
  std::vector<std::vector<std::string>> rows(1);
  for (const std::string& key : keys) rows[0].push_back(last_word(key));
  rows[0].insert(rows[0].end(),
                 {"mean over runs", "verdict", "runs", "error", "tolerance", "deviation of a run", ""});
  for (const EnsembleMean& mean : means) {
    auto& row = rows.emplace_back(mean.values);
    row.insert(row.end(), {mean.reference, std::string(name_of(mean.result.verdict)),
                           fmt::format("{} of {}", mean.finished, mean.runs),
                           std::isfinite(mean.result.error) ? percent_text(mean.result.error) : "",
                           percent_text(mean.result.tolerance),
                           std::isfinite(mean.result.deviation) ? percent_text(mean.result.deviation) : "",
                           mean.result.remark});
  }
  return table(rows, keys.size() + 2, "  ");
}

std::string ensemble_csv(const std::vector<std::string>& keys, const std::vector<EnsembleMean>& means) {
  std::string text;
  for (const std::string& key : keys) text += csv_cell(key) + ",";
  text += "reference,runs,error of the mean,tolerance,deviation of a run,verdict\n";
  for (const EnsembleMean& mean : means) {
    for (const std::string& value : mean.values) text += csv_cell(value) + ",";
    text += fmt::format("{},{},{},{},{},{}\n", csv_cell(mean.reference), mean.finished,
                        csv_number(mean.result.error), mean.result.tolerance,
                        csv_number(mean.result.deviation), name_of(mean.result.verdict));
  }
  return text;
}

}  // namespace shoal::kernel::app
