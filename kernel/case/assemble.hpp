// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// From a checked case to a simulation: particles in their shapes, materials, physics.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/case/model.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel {

class Materials;

/// A simulation that all physics have spoken to; outputs and probes may still demand fields before it is finalised.
struct Assembly {
  Assembly();
  ~Assembly();
  Assembly(Assembly&&) noexcept;
  Assembly& operator=(Assembly&&) = delete;

  std::unique_ptr<Materials> materials;  ///< outlive the simulation, whose operators call them
  std::unique_ptr<Simulation> run;
};

struct AssemblyOptions {
  int threads = 0;  ///< 0: as many as the machine has
  /// Bodies of relaxed particles stay on their lattices: enough for a plan, and quick.
  bool skip_relaxation = false;
  /// Whether plugin `a` requires plugin `b`: then the physics of `b` are built first.
  std::function<bool(std::string_view a, std::string_view b)> requires_plugin;
};

/// What the user asked for cannot be built, with its place: ModelError of the parts below it. The model must outlive
/// the assembly. Throws ModelError, PluginFailure, and what a plugin's other callbacks throw.
Assembly assemble(const CaseModel& model, const AssemblyOptions& options);

}  // namespace shoal::kernel
