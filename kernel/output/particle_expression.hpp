// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Expressions over the particles of a body: 0.5 * mass * velocity.magnitude^2, position.y > 0.1. Names are fields and
// their parts, the case's parameters, the particle's place x, y, z, and t.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/case/expression.hpp"
#include "kernel/output/field_part.hpp"

namespace shoal::kernel {

/// A particle, or one of its images behind a periodic or mirror face.
struct ParticleImage {
  std::uint64_t index = 0;
  std::array<double, 3> position{};
  std::array<double, 3> flip{1.0, 1.0, 1.0};
};

class ParticleExpression {
 public:
  /// `parameters` knows the case's parameters; `place` is that of the text in the case. Throws ModelError.
  ParticleExpression(const std::string& text, ExpressionScope parameters, int dimensions, std::string place);

  const std::string& text() const { return expression_.text(); }
  const std::string& place() const { return place_; }
  /// The fields that it needs, without the position, which is always there.
  std::vector<std::string> fields() const;
  /// The unit where the expression is one part of one field; else empty.
  std::string unit(const Simulation& run, std::uint32_t body) const;

  /// Looks the fields of `body` up; once all fields are there. Throws ModelError.
  void bind(const Simulation& run, std::uint32_t body);
  /// Values of particles begin .. end-1 of a bound body. [any thread]
  void evaluate(const Simulation& run, std::uint32_t body, std::uint64_t begin, std::uint64_t end,
                double* out) const;
  /// Values of chosen particles or images.
  std::vector<double> evaluate(const Simulation& run, std::uint32_t body,
                               const std::vector<ParticleImage>& particles) const;

 private:
  struct Bound {
    std::uint32_t body;
    std::vector<FieldPart> parts;  ///< in the order of the expression's fields
  };
  const Bound& bound(std::uint32_t body) const;

  Expression expression_;
  int dimensions_;
  std::string place_;
  std::vector<Bound> bodies_;
};

}  // namespace shoal::kernel
