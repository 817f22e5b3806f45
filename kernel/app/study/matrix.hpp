// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The runs of a study: every combination of the values that --vary names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace shoal::kernel::app {

/// One --vary or --ensemble KEY=VALUE,VALUE,...
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// `option`: --vary or --ensemble, for messages. Commas inside brackets do not separate values. Throws UserError.
Variation read_variation(const std::string& option, const std::string& text);

struct StudyRun {
  std::string name;                 ///< of its folder, e.g. "dx=0.05_scheme=new"
  std::vector<std::string> values;  ///< in the order of the variations
};

/// The first variation changes slowest. Names are unique and need no quotes in a shell.
std::vector<StudyRun> matrix(const std::vector<Variation>& variations);

}  // namespace shoal::kernel::app
