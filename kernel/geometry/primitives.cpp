// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Box, ball, cylinder and half space: shapes with an exact distance in closed form.
#include <sstream>
#include <stdexcept>

#include "shape.hpp"

namespace shoal::kernel {
namespace {

[[noreturn]] void refuse(const std::ostringstream& sentence) { throw std::invalid_argument(sentence.str()); }

void require_finite(const Point& p, const char* what) {
  if (point::finite(p)) return;
  std::ostringstream out;
  out << what << " must be finite, but is (" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  refuse(out);
}

void require_radius(double radius, const char* of) {
  if (std::isfinite(radius) && radius > 0.0) return;
  std::ostringstream out;
  out << "the radius of a " << of << " must be positive, but is " << radius;
  refuse(out);
}

/// Signed distance to a solid between perpendicular pairs of faces, from the signed excess over each pair.
double distance_from_excess(const Point& excess) {
  const double most = std::max({excess[0], excess[1], excess[2]});
  if (most <= 0.0) return most;
  const Point positive{std::max(excess[0], 0.0), std::max(excess[1], 0.0), std::max(excess[2], 0.0)};
  return point::length(positive);
}

}  // namespace

BoxShape::BoxShape(const Parameters& parameters)
    : box_{parameters.lower, parameters.upper}, dimension_(parameters.dimension) {
  if (dimension_ != 2 && dimension_ != 3) {
    std::ostringstream out;
    out << "a box has 2 or 3 dimensions, not " << dimension_;
    refuse(out);
  }
  if (dimension_ == 2) {
    box_.lower[2] = -infinity;
    box_.upper[2] = infinity;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (box_.lower[a] < box_.upper[a]) continue;
    std::ostringstream out;
    out << "the lower corner of a box must lie below its upper corner, but along "
        << "xyz"[a] << " lower is " << box_.lower[a] << " and upper is " << box_.upper[a];
    refuse(out);
  }
}

double BoxShape::signed_distance(const Point& p) const {
  Point excess{};
  for (std::size_t a = 0; a < 3; ++a) excess[a] = std::max(box_.lower[a] - p[a], p[a] - box_.upper[a]);
  return distance_from_excess(excess);
}

Point BoxShape::normal(const Point& p) const {
  Point outward{};
  for (std::size_t a = 0; a < 3; ++a) {
    outward[a] = p[a] - std::clamp(p[a], box_.lower[a], box_.upper[a]);
  }
  if (point::dot(outward, outward) > 0.0) return point::unit(outward, {1.0, 0.0, 0.0});
  // Inside: the nearest face, or the mean of faces that are equally near, so that edges have the bisector.
  const double depth = signed_distance(p);
  const double tie = 1e-12 * (std::abs(depth) + point::length(p));
  Point mean{};
  Point first{1.0, 0.0, 0.0};
  bool found = false;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const double side : {-1.0, 1.0}) {
      const double excess = side < 0.0 ? box_.lower[a] - p[a] : p[a] - box_.upper[a];
      if (excess < depth - tie || !std::isfinite(excess)) continue;
      mean[a] += side;
      if (!found) first = {a == 0 ? side : 0.0, a == 1 ? side : 0.0, a == 2 ? side : 0.0};
      found = true;
    }
  }
  return point::unit(mean, first);
}

bool BoxShape::holds(const Point& p, double tolerance) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (p[a] < box_.lower[a] - tolerance || p[a] >= box_.upper[a] - tolerance) return false;
  }
  return true;
}

ShapePtr BoxShape::grown_sharply(double distance) const {
  Parameters grown_box{box_.lower, box_.upper, dimension_};
  for (std::size_t a = 0; a < 3; ++a) {
    grown_box.lower[a] -= distance;
    grown_box.upper[a] += distance;
    if (grown_box.lower[a] < grown_box.upper[a]) continue;
    std::ostringstream out;
    out << "a box of side " << box_.upper[a] - box_.lower[a] << " along "
        << "xyz"[a] << " leaves nothing when it shrinks by " << -distance
        << " on each side; take a smaller thickness, or the box itself";
    refuse(out);
  }
  return std::make_shared<BoxShape>(grown_box);
}

Ball::Ball(const Parameters& parameters) : ball_(parameters) {
  require_finite(ball_.centre, "the centre of a ball");
  require_radius(ball_.radius, "ball");
}

double Ball::signed_distance(const Point& p) const {
  return point::length(point::minus(p, ball_.centre)) - ball_.radius;
}

Point Ball::normal(const Point& p) const {
  return point::unit(point::minus(p, ball_.centre), {1.0, 0.0, 0.0});
}

Box Ball::bounds() const {
  const Point reach{ball_.radius, ball_.radius, ball_.radius};
  return {point::minus(ball_.centre, reach), point::plus(ball_.centre, reach)};
}

ShapePtr Ball::grown_sharply(double distance) const {
  if (ball_.radius + distance <= 0.0) {
    std::ostringstream out;
    out << "a ball of radius " << ball_.radius << " leaves nothing when it shrinks by " << -distance
        << "; take a smaller thickness, or the ball itself";
    refuse(out);
  }
  return std::make_shared<Ball>(Parameters{ball_.centre, ball_.radius + distance});
}

struct Cylinder::Section {
  double radial_excess;
  double axial_excess;
  Point radial;  // unit, away from the axis
  Point axial;   // unit, towards the nearer end
};

Cylinder::Cylinder(const Parameters& parameters) : cylinder_(parameters) {
  require_finite(cylinder_.from, "the end 'from' of a cylinder");
  require_finite(cylinder_.to, "the end 'to' of a cylinder");
  require_radius(cylinder_.radius, "cylinder");
  const Point between = point::minus(cylinder_.to, cylinder_.from);
  const double length = point::length(between);
  if (!(length > 0.0)) {
    throw std::invalid_argument("the ends of a cylinder must differ; 'from' and 'to' are the same point");
  }
  axis_ = point::times(1.0 / length, between);
  half_length_ = 0.5 * length;
  middle_ = point::along(cylinder_.from, 0.5, between);
}

Cylinder::Section Cylinder::section(const Point& p) const {
  const Point from_middle = point::minus(p, middle_);
  const double t = point::dot(from_middle, axis_);
  const Point across = point::along(from_middle, -t, axis_);
  const double r = point::length(across);
  // On the axis every radial direction is as good: take one that is truly perpendicular.
  Point sideways{1.0, 0.0, 0.0};
  if (std::abs(axis_[0]) > 0.7) sideways = {0.0, 1.0, 0.0};
  sideways = point::unit(point::along(sideways, -point::dot(sideways, axis_), axis_), sideways);
  return {r - cylinder_.radius, std::abs(t) - half_length_, point::unit(across, sideways),
          point::times(t < 0.0 ? -1.0 : 1.0, axis_)};
}

double Cylinder::signed_distance(const Point& p) const {
  const Section s = section(p);
  return distance_from_excess({s.radial_excess, s.axial_excess, -infinity});
}

Point Cylinder::normal(const Point& p) const {
  const Section s = section(p);
  if (s.radial_excess > 0.0 && s.axial_excess > 0.0) {
    return point::unit(point::along(point::times(s.radial_excess, s.radial), s.axial_excess, s.axial),
                       s.radial);
  }
  return s.radial_excess >= s.axial_excess ? s.radial : s.axial;
}

bool Cylinder::holds(const Point& p, double tolerance) const {
  if (section(p).radial_excess > tolerance) return false;
  const double up = point::dot(point::upper_side, axis_);
  const double t = point::dot(point::minus(p, middle_), axis_) + tolerance * up;
  return up >= 0.0 ? -half_length_ <= t && t < half_length_ : -half_length_ < t && t <= half_length_;
}

ShapePtr Cylinder::grown_sharply(double distance) const {
  if (cylinder_.radius + distance <= 0.0 || half_length_ + distance <= 0.0) {
    std::ostringstream out;
    out << "a cylinder of radius " << cylinder_.radius << " and length " << 2.0 * half_length_
        << " leaves nothing when it shrinks by " << -distance
        << "; take a smaller thickness, or the cylinder itself";
    refuse(out);
  }
  return std::make_shared<Cylinder>(Parameters{point::along(cylinder_.from, -distance, axis_),
                                               point::along(cylinder_.to, distance, axis_),
                                               cylinder_.radius + distance});
}

Box Cylinder::bounds() const {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    const double reach = cylinder_.radius * std::sqrt(std::max(0.0, 1.0 - axis_[a] * axis_[a]));
    box.lower[a] = std::min(cylinder_.from[a], cylinder_.to[a]) - reach;
    box.upper[a] = std::max(cylinder_.from[a], cylinder_.to[a]) + reach;
  }
  return box;
}

HalfSpace::HalfSpace(const Parameters& parameters) : plane_(parameters) {
  require_finite(plane_.point, "the point of a half space");
  require_finite(plane_.normal, "the normal of a half space");
  if (!(point::length(plane_.normal) > 0.0)) {
    throw std::invalid_argument("the normal of a half space must not be zero; it points out of the shape");
  }
  plane_.normal = point::unit(plane_.normal, plane_.normal);
}

double HalfSpace::signed_distance(const Point& p) const {
  return point::dot(point::minus(p, plane_.point), plane_.normal);
}

Point HalfSpace::normal(const Point& /*p*/) const { return plane_.normal; }

Box HalfSpace::bounds() const {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    if (plane_.normal[a] == 1.0) box.upper[a] = plane_.point[a];
    if (plane_.normal[a] == -1.0) box.lower[a] = plane_.point[a];
  }
  return box;
}

bool HalfSpace::holds(const Point& p, double tolerance) const {
  const double up = point::dot(point::upper_side, plane_.normal);
  const double distance = signed_distance(p) + tolerance * up;
  return distance < 0.0 || (distance == 0.0 && up < 0.0);
}

ShapePtr HalfSpace::grown_sharply(double distance) const {
  return std::make_shared<HalfSpace>(
      Parameters{point::along(plane_.point, distance, plane_.normal), plane_.normal});
}

}  // namespace shoal::kernel
