// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A shape scaled, turned and moved: p = centre + R S (q - centre) + translation, q being a point of the
// shape.
#include <sstream>
#include <stdexcept>

#include "shape.hpp"

namespace shoal::kernel {
namespace {

/// Rodrigues' formula. Entries that are zero but for rounding become zero, so that quarter turns map boxes to
/// boxes.
std::array<Point, 3> rotation_matrix(const Point& k, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const std::array<Point, 3> cross{{{0.0, -k[2], k[1]}, {k[2], 0.0, -k[0]}, {-k[1], k[0], 0.0}}};
  std::array<Point, 3> rotation{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      double entry = (a == b ? c : 0.0) + s * cross[a][b] + (1.0 - c) * k[a] * k[b];
      if (std::abs(entry) < 1e-15) entry = 0.0;
      if (std::abs(std::abs(entry) - 1.0) < 1e-15) entry = entry < 0.0 ? -1.0 : 1.0;
      rotation[a][b] = entry;
    }
  }
  return rotation;
}

}  // namespace

Transform::Transform(const Parameters& parameters) : parameters_(parameters) {
  if (!parameters_.of) throw std::invalid_argument("there is no shape to transform");
  if (parameters_.dimension != 2 && parameters_.dimension != 3) {
    std::ostringstream out;
    out << "a transform has 2 or 3 dimensions, not " << parameters_.dimension;
    throw std::invalid_argument(out.str());
  }
  if (parameters_.dimension == 2) parameters_.scale[2] = 1.0;
  const Point& scale = parameters_.scale;
  if (!point::finite(scale) || *std::min_element(scale.begin(), scale.end()) <= 0.0) {
    std::ostringstream out;
    out << "the scales of a transform must be positive, but are (" << scale[0] << ", " << scale[1] << ", "
        << scale[2] << ")";
    throw std::invalid_argument(out.str());
  }
  if (!point::finite(parameters_.axis) || !(point::length(parameters_.axis) > 0.0)) {
    throw std::invalid_argument("the axis of a rotation must be a finite vector other than zero");
  }
  if (!std::isfinite(parameters_.angle) || !point::finite(parameters_.centre) ||
      !point::finite(parameters_.translation)) {
    throw std::invalid_argument("the angle, centre and translation of a transform must be finite");
  }
  parameters_.axis = point::unit(parameters_.axis, parameters_.axis);
  if (parameters_.dimension == 2 && (parameters_.axis[0] != 0.0 || parameters_.axis[1] != 0.0)) {
    throw std::invalid_argument(
        "in two dimensions a shape turns about z only; leave the axis out, or make it (0, 0, 1)");
  }
  rotation_ = rotation_matrix(parameters_.axis, parameters_.angle);
  smallest_scale_ = std::min(scale[0], scale[1]);
  if (parameters_.dimension == 3) smallest_scale_ = std::min(smallest_scale_, scale[2]);
}

bool Transform::scales_equally() const {
  const Point& s = parameters_.scale;
  return s[0] == s[1] && (parameters_.dimension == 2 || s[0] == s[2]);
}

Point Transform::to_shape(const Point& p) const {
  const Point moved = point::minus(point::minus(p, parameters_.translation), parameters_.centre);
  Point q{};
  for (std::size_t b = 0; b < 3; ++b) {
    double turned = 0.0;
    for (std::size_t a = 0; a < 3; ++a) turned += rotation_[a][b] * moved[a];
    q[b] = parameters_.centre[b] + turned / parameters_.scale[b];
  }
  return q;
}

Point Transform::direction_from_shape(const Point& n) const {
  // Normals go with the inverse transpose, R S^-1.
  Point scaled{};
  for (std::size_t a = 0; a < 3; ++a) scaled[a] = n[a] / parameters_.scale[a];
  Point turned{};
  for (std::size_t a = 0; a < 3; ++a) turned[a] = point::dot(rotation_[a], scaled);
  return point::unit(turned, {1.0, 0.0, 0.0});
}

double Transform::signed_distance(const Point& p) const {
  return smallest_scale_ * parameters_.of->signed_distance(to_shape(p));
}

Point Transform::normal(const Point& p) const {
  return direction_from_shape(parameters_.of->normal(to_shape(p)));
}

Face Transform::face(const Point& p) const {
  const Face inner = parameters_.of->face(to_shape(p));
  return {smallest_scale_ * inner.distance, direction_from_shape(inner.normal)};
}

bool Transform::distance_is_exact() const { return scales_equally() && parameters_.of->distance_is_exact(); }

bool Transform::valid_in(int dimension) const {
  if (!parameters_.of->valid_in(dimension)) return false;
  const bool about_z = parameters_.axis[0] == 0.0 && parameters_.axis[1] == 0.0;
  return dimension == 3 ? parameters_.dimension == 3 : about_z || parameters_.angle == 0.0;
}

bool Transform::holds(const Point& p, double tolerance) const {
  return parameters_.of->contains(to_shape(p), tolerance / smallest_scale_);
}

ShapePtr Transform::grown_sharply(double distance) const {
  if (!scales_equally()) return nullptr;
  Parameters around = parameters_;
  around.of = parameters_.of->grown_sharply(distance / smallest_scale_);
  return around.of ? std::make_shared<Transform>(around) : nullptr;
}

Box Transform::bounds() const {
  const Box inner = parameters_.of->bounds();
  Box outer;
  for (std::size_t a = 0; a < 3; ++a) {
    double lower = parameters_.centre[a] + parameters_.translation[a];
    double upper = lower;
    for (std::size_t b = 0; b < 3; ++b) {
      const double entry = rotation_[a][b] * parameters_.scale[b];
      if (entry == 0.0) continue;  // an infinite side must not spoil the axes that it has no part in
      const double one = entry * (inner.lower[b] - parameters_.centre[b]);
      const double two = entry * (inner.upper[b] - parameters_.centre[b]);
      lower += std::min(one, two);
      upper += std::max(one, two);
    }
    outer.lower[a] = lower;
    outer.upper[a] = upper;
  }
  return outer;
}

}  // namespace shoal::kernel
