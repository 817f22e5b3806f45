// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of a study that differ by chance alone: the mean over them against the references of the case.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernel/output/reference.hpp"

namespace shoal::kernel::app {

struct EnsembleMean {
  std::vector<std::string> values;  ///< of the other variations
  std::string reference;            ///< as among the errors of runs: "wall_pressure rms"
  std::size_t finished = 0, runs = 0;
  EnsembleResult result;  ///< incomplete where not all runs finished
};

/// `keys`: of the other variations.
std::string ensemble_table(const std::vector<std::string>& keys, const std::vector<EnsembleMean>& means);
std::string ensemble_csv(const std::vector<std::string>& keys, const std::vector<EnsembleMean>& means);

}  // namespace shoal::kernel::app
