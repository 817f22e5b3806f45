// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The longest stable time steps of a case: each factor of time steps that its physics declares is raised from where it
// stands, in steps of a tenth, to three times that at most. Of two neighbouring values the first holds and the second
// fails; they are found by halving, so not every smaller value has run. A run has failed if
//
//   it does not end:           NaN, escape, a value that the physics guards, a collapsed time step, an error; or
//   a reference is missed:     its error exceeds both the tolerance and twice that of the case as it stands; or
//   another probe runs away:   it is not a number, or exceeds twice its largest magnitude in the case as it stands.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/app/study/runner.hpp"
#include "kernel/case/model.hpp"

namespace shoal::kernel::app {

struct StepFactor {
  std::string key;  ///< for --set: "physics.0.fluid.wcsph.acoustic_cfl"
  double standard = 0.0;
  std::optional<double> largest;  ///< that is allowed
};

/// What the physics of a case declares (SHOAL_PARAMETER_STEP_FACTOR), with the values of the case.
std::vector<StepFactor> declared_step_factors(const CaseModel& model);

/// --limit KEY, of those declared, or KEY=VALUE. Throws UserError.
StepFactor read_step_factor(const std::string& text, const std::vector<StepFactor>& declared);

/// The values that may be tried after the standard one, in their order.
std::vector<std::string> raised_values(const StepFactor& factor);

struct Limit {
  StepFactor factor;
  std::string holds_to;  ///< empty if the case does not even hold as it stands
  std::string fails_at;  ///< empty if nothing that was tried failed
  std::string why;       ///< it failed, or is not known
};

/// `standard`: of the case as it stands, in `folder`. Empty if the run in `raised` has not failed.
std::string failure_of(const StudyResult& run, const std::filesystem::path& folder,
                       const StudyResult& standard, const std::filesystem::path& standard_folder);

/// `standard`: the case as it stands; the other runs are in FOLDER/KEY/KEY=VALUE.
std::vector<Limit> find_limits(CaseRunner& runner, const std::vector<StepFactor>& factors,
                               const RunRequest& standard, const std::filesystem::path& folder);

/// For people, and for machines.
std::string limits_table(const std::vector<Limit>& limits);
std::string limits_csv(const std::vector<Limit>& limits);

}  // namespace shoal::kernel::app
