// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// One output of a case: when it is due, what its snapshots hold, and the plugin that writes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "kernel/case/model.hpp"
#include "kernel/output/due.hpp"
#include "kernel/output/snapshot.hpp"
#include "kernel/schedule/simulation.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

class OutputWriter {
 public:
  /// `name` is that of its folder. Demands its fields. Throws ModelError.
  OutputWriter(const shoal_object& object, const CaseModel& model, std::string name, Simulation& run);
  OutputWriter(const OutputWriter&) = delete;
  OutputWriter& operator=(const OutputWriter&) = delete;
  ~OutputWriter();

  const std::string& name() const { return name_; }
  const Due& due() const { return due_; }
  std::uint64_t sequence() const { return sequence_; }

  /// Once the run is finalised: what is written where the case does not say. Throws ModelError.
  void bind(const Simulation& run);
  /// `sequence` is the number of the next snapshot. Throws PluginFailure.
  void open(const std::filesystem::path& folder, std::uint64_t sequence);
  void write(const Simulation& run);
  /// Another object of the same type writes everything there is, once.
  void dump(const Simulation& run, const std::filesystem::path& folder) const;

 private:
  void* create(const std::filesystem::path& folder, std::uint64_t sequence) const;
  void write(void* self, const Snapshot& snapshot) const;
  void choose_bodies(const CaseModel& model);
  void choose_fields(Simulation& run);

  const shoal_object& object_;
  const shoal_type& table_;
  shoal_output_api api_;
  std::string name_, type_, plugin_, title_;
  Due due_;
  SnapshotRequest request_;
  bool fields_given_ = false;
  std::uint64_t sequence_ = 0;
  void* self_ = nullptr;
};

/// All bodies with all their fields.
SnapshotRequest everything(const Simulation& run);

}  // namespace shoal::kernel
