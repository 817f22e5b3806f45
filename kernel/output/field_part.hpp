// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A number of a particle by its name: a scalar field (pressure), a component of a larger one (velocity.x, strain.xy),
// or an invariant of it (velocity.magnitude, strain.trace).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel {

/// "velocity" of "velocity.x".
std::string field_of(std::string_view name);
/// "x" of "velocity.x", empty without one.
std::string part_of(std::string_view name);
/// Whether the name could mean a number of a particle, before it is known which fields there are.
bool is_part_name(std::string_view name);

/// The names of a field's parts: x, y, magnitude; c0, c1, ... of an array of n_components.
std::vector<std::string> part_names(shoal_rank rank, int dimensions, std::uint32_t n_components);

class FieldPart {
 public:
  /// What `name` means of a field. Throws ModelError with the parts that there are; place: in the case.
  FieldPart(const FieldInfo& field, std::string_view name, int dimensions, const std::string& place);

  /// Value of particle `index`; `flip` holds -1 for axes along which the particle is seen in a mirror, else 1.
  double value(const shoal_field& field, std::uint64_t index, const std::array<double, 3>& flip) const;
  /// Whether the value is the number that stands in the array, at `component`.
  bool is_component() const { return how_ == How::component; }
  std::uint32_t component() const { return component_; }
  const std::string& unit() const { return unit_; }

 private:
  enum class How { component, magnitude, trace, determinant };
  double number(const shoal_field& field, std::uint64_t index, std::uint32_t component) const;

  How how_ = How::component;
  std::uint32_t component_ = 0;
  std::array<int, 2> axes_{-1, -1};  // of the component, for mirrors
  shoal_rank rank_;
  shoal_data_type data_type_;
  std::uint32_t components_;
  int dimensions_;
  std::string unit_;
};

}  // namespace shoal::kernel
