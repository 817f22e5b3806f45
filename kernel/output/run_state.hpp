// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The head of a checkpoint: all that going on needs beside the simulation's own state.
#pragma once

#include <string>
#include <vector>

#include "kernel/output/recorder.hpp"

namespace shoal::kernel {

struct RunState {
  std::string version;  ///< of Shoal
  std::string effective_case;
  double time = 0.0;          ///< s
  double wall_seconds = 0.0;  ///< of all sessions until then
  std::string finish_reason;  ///< if an operator ended the run here
  RecorderState recorder;
};

std::string to_text(const RunState& state);
/// Throws CheckpointError.
RunState state_from_text(const std::string& text);

/// What differs between two effective cases, as lines "bodies.water.resolution: 0.02 -> 0.01".
std::vector<std::string> differences(const std::string& before, const std::string& now);
/// Of these, what makes them different computations: titles, the end of the run, outputs, probes and references may
/// differ.
std::vector<std::string> differing_physics(const std::string& before, const std::string& now);

}  // namespace shoal::kernel
