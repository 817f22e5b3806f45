// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/field_part.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/schema.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {
namespace {

struct Component {
  std::string name;
  std::array<int, 2> axes{-1, -1};
};

std::vector<Component> components_of(shoal_rank rank, int dimensions, std::uint32_t n_components) {
  const std::string axes = "xyz";
  std::vector<Component> all;
  if (rank == SHOAL_ARRAY)
    for (std::uint32_t c = 0; c < n_components; ++c) all.push_back({"c" + std::to_string(c), {-1, -1}});
  for (int a = 0; a < dimensions; ++a) {
    if (rank == SHOAL_RANK_VECTOR) all.push_back({axes.substr(static_cast<std::size_t>(a), 1), {a, -1}});
    for (int b = rank == SHOAL_SYMMETRIC ? a : 0; b < dimensions; ++b) {
      if (rank == SHOAL_SYMMETRIC || rank == SHOAL_RANK_MATRIX)
        all.push_back(
            {std::string{axes[static_cast<std::size_t>(a)], axes[static_cast<std::size_t>(b)]}, {a, b}});
    }
  }
  return all;
}

// Where component (a, b) of a symmetric matrix or matrix stands.
std::uint32_t position_of(shoal_rank rank, int dimensions, int a, int b) {
  if (rank == SHOAL_RANK_MATRIX) return static_cast<std::uint32_t>(a * dimensions + b);
  if (a > b) std::swap(a, b);
  return static_cast<std::uint32_t>(a * dimensions - a * (a - 1) / 2 + b - a);
}

}  // namespace

std::string field_of(std::string_view name) { return std::string(name.substr(0, name.find('.'))); }

std::string part_of(std::string_view name) {
  const std::size_t dot = name.find('.');
  return dot == std::string_view::npos ? std::string() : std::string(name.substr(dot + 1));
}

bool is_part_name(std::string_view name) { return is_field_name(std::string(name)); }

std::vector<std::string> part_names(shoal_rank rank, int dimensions, std::uint32_t n_components) {
  std::vector<std::string> names;
  for (const Component& component : components_of(rank, dimensions, n_components))
    names.push_back(component.name);
  if (rank != SHOAL_SCALAR && rank != SHOAL_ARRAY) names.emplace_back("magnitude");
  if (rank == SHOAL_SYMMETRIC || rank == SHOAL_RANK_MATRIX) {
    names.emplace_back("trace");
    names.emplace_back("determinant");
  }
  return names;
}

FieldPart::FieldPart(const FieldInfo& field, std::string_view name, int dimensions, const std::string& place)
    : rank_(field.rank),
      data_type_(field.data_type),
      components_(field.components),
      dimensions_(dimensions),
      unit_(field.unit) {
  const std::string part = part_of(name);
  std::vector<std::string> names = part_names(rank_, dimensions, components_);
  if (part.empty() && rank_ == SHOAL_SCALAR) return;
  if (rank_ == SHOAL_SCALAR)
    throw ModelError("the field '" + field.name + "' is a number and has no '" + part + "'", place);
  if (part.empty()) {
    for (std::string& text : names) text.insert(0, field.name + ".");
    throw ModelError("'" + field.name + "' is more than one number here; choose one of " + join(names),
                     place);
  }
  if (part == "magnitude" && rank_ != SHOAL_ARRAY) {
    how_ = How::magnitude;
    return;
  }
  const bool is_matrix = rank_ == SHOAL_SYMMETRIC || rank_ == SHOAL_RANK_MATRIX;
  if (is_matrix && part == "trace") {
    how_ = How::trace;
    return;
  }
  if (is_matrix && part == "determinant") {
    how_ = How::determinant;
    unit_ = unit_ == "1" ? "1" : "";
    return;
  }
  const std::vector<Component> all = components_of(rank_, dimensions, components_);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].name != part) continue;
    component_ = static_cast<std::uint32_t>(k);
    axes_ = all[k].axes;
    return;
  }
  throw ModelError("the field '" + field.name + "' has no part '" + part + "'" + did_you_mean(part, names) +
                       " (" + join(names) + ")",
                   place);
}

double FieldPart::number(const shoal_field& field, std::uint64_t index, std::uint32_t component) const {
  const std::uint64_t k = index * components_ + component;
  if (data_type_ == SHOAL_INT64) return static_cast<double>(static_cast<const std::int64_t*>(field.data)[k]);
  return static_cast<const double*>(field.data)[k];
}

double FieldPart::value(const shoal_field& field, std::uint64_t index,
                        const std::array<double, 3>& flip) const {
  if (how_ == How::component) {
    double sign = 1.0;
    for (const int axis : axes_)
      if (axis >= 0) sign *= flip[static_cast<std::size_t>(axis)];
    return sign * number(field, index, component_);
  }
  const auto at = [&](int a, int b) { return number(field, index, position_of(rank_, dimensions_, a, b)); };
  double result = 0.0;
  if (how_ == How::trace) {
    for (int a = 0; a < dimensions_; ++a) result += at(a, a);
    return result;
  }
  if (how_ == How::determinant) {
    if (dimensions_ == 2) return at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      result += at(0, a) * (at(1, b) * at(2, c) - at(1, c) * at(2, b));
    }
    return result;
  }
  // Frobenius norm; off-diagonal components of a symmetric matrix count twice.
  for (int a = 0; a < dimensions_; ++a) {
    if (rank_ == SHOAL_RANK_VECTOR) {
      const double v = number(field, index, static_cast<std::uint32_t>(a));
      result += v * v;
      continue;
    }
    for (int b = 0; b < dimensions_; ++b) result += at(a, b) * at(a, b);
  }
  return std::sqrt(result);
}

}  // namespace shoal::kernel
