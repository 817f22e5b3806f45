// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Ranges that fields must stay in. Checked once per outer step in one vectorised pass per guarded field; the slow
// search for the worst particles happens only once the run has failed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/particles/body.hpp"
#include "kernel/particles/domain.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {

/// Where a failure is to be reported.
struct Whereabouts {
  std::string loop;
  std::uint64_t step = 0;
  double time = 0.0;  // s
};

class Health {
 public:
  /// Guards every body's positions (inside the domain) and, where there are any, velocities (finite). Where the case
  /// gives no domain on an open axis, positions may leave the initial bounds of all particles by their extent.
  void watch(const Domain& domain, std::vector<std::unique_ptr<Body>>& bodies);
  void guard(Body& body, Field& field, double minimum, double maximum);

  /// Throws PhysicsFailure with the worst particles. Fields that have not changed since they held are not looked at.
  void check(const Whereabouts& where);
  /// Only the positions of bodies that have moved: before neighbours are searched.
  void check_positions(const Whereabouts& where);

 private:
  struct Guard {
    Body* body = nullptr;
    Field* field = nullptr;
    std::vector<double> minimum, maximum;  ///< per component
    enum class Kind { position, finite, range } kind = Kind::range;
    std::uint64_t held_at = UINT64_MAX;  ///< the field's count of changes when it last held
  };
  static bool holds(Guard& guard);
  [[noreturn]] static void fail(const Guard& guard, const Whereabouts& where);

  std::vector<Guard> guards_;
};

/// id, body and position of a particle, with the value that gave it away.
PhysicsFailure::Particle describe_particle(const Body& body, std::uint64_t index, const std::string& field,
                                           double value);

}  // namespace shoal::kernel
