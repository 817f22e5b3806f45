// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What can go wrong between a checked case and its end. Each kind has its own exit code in the program; the
// texts are written for the user.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace shoal::kernel {

/// The case, or a plugin's declarations, cannot be scheduled: a clash of field types, an unknown stage, an output of
/// a field that nobody computes. `place` is a position in a case ("dam_break.yaml:12:51") where one is known.
class ModelError : public std::runtime_error {
 public:
  explicit ModelError(const std::string& message, std::string place = {})
      : std::runtime_error(message), place_(std::move(place)) {}
  const std::string& place() const { return place_; }

 private:
  std::string place_;
};

/// A callback of a plugin returned SHOAL_ERROR, or did what its contract forbids.
class OperatorFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A checkpoint cannot be written or read: foreign, damaged, truncated, or of another case.
class CheckpointError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run left what the model can describe. what() is the whole story in a few lines; the members are for dumps.
class PhysicsFailure : public std::runtime_error {
 public:
  struct Particle {
    std::int64_t id = -1;
    std::string body;
    std::uint64_t index = 0;  ///< in the body's arrays
    double position[3] = {0.0, 0.0, 0.0};
    std::string field;   ///< the field that gave the particle away
    double value = 0.0;  ///< of its worst component
  };
  struct Report {
    std::string cause;  ///< one sentence
    std::string loop;
    std::uint64_t step = 0;       ///< of that loop
    double time = 0.0;            ///< s
    std::vector<Particle> worst;  ///< at most five
  };
  explicit PhysicsFailure(Report report);
  const Report& report() const { return report_; }

 private:
  Report report_;
};

}  // namespace shoal::kernel
