// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The text of a physics failure: cause, where and when, and the particles to look at first.
#include "kernel/particles/errors.hpp"

#include <cstdio>

namespace shoal::kernel {

namespace {

std::string describe(const PhysicsFailure::Report& report) {
  char line[512];
  std::snprintf(line, sizeof line, "\n  loop %s, step %llu, t = %.9g s", report.loop.c_str(),
                static_cast<unsigned long long>(report.step), report.time);
  std::string text = report.cause + line;
  for (const PhysicsFailure::Particle& particle : report.worst) {
    std::snprintf(line, sizeof line, "\n  particle %lld of %s at (%.6g, %.6g, %.6g): %s = %.9g",
                  static_cast<long long>(particle.id), particle.body.c_str(), particle.position[0],
                  particle.position[1], particle.position[2], particle.field.c_str(), particle.value);
    text += line;
  }
  return text;
}

}  // namespace

PhysicsFailure::PhysicsFailure(Report report)
    : std::runtime_error(describe(report)), report_(std::move(report)) {}

}  // namespace shoal::kernel
