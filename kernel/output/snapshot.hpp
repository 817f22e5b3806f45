// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Chosen bodies and fields of a run at one time, as outputs and probes of plugins see them.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "kernel/output/field_part.hpp"
#include "kernel/schedule/simulation.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

struct SnapshotRequest {
  struct BodyFields {
    std::uint32_t body = 0;
    std::vector<std::string> fields;  ///< or their parts, "velocity.x"; without the position
    std::string place;                ///< in the case, for messages
  };
  std::vector<BodyFields> bodies;
};

/// Views of the run's own arrays: valid until it goes on. Parts of fields are copies.
class Snapshot {
 public:
  /// Throws ModelError if a field is not there.
  Snapshot(const Simulation& run, const SnapshotRequest& request, std::uint64_t sequence);
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;
  const shoal_snapshot* c() const { return &snapshot_; }

 private:
  shoal_snapshot_field field(const Simulation& run, const SnapshotRequest::BodyFields& wanted,
                             const std::string& name);

  shoal_snapshot snapshot_{};
  std::vector<shoal_snapshot_body> bodies_;
  std::deque<std::vector<shoal_snapshot_field>> fields_;
  std::deque<std::string> texts_;
  std::deque<std::vector<double>> copies_;
};

}  // namespace shoal::kernel
