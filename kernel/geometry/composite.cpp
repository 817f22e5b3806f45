// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Shapes made of shapes: union, intersection, difference and shell.
#include <sstream>
#include <stdexcept>
#include <utility>

#include "shape.hpp"

namespace shoal::kernel {
namespace {

void require_shapes(const std::vector<ShapePtr>& shapes, const char* what) {
  if (shapes.empty()) throw std::invalid_argument(std::string(what) + " needs at least one shape");
  for (const ShapePtr& shape : shapes) {
    if (!shape) throw std::invalid_argument(std::string("a shape of ") + what + " is missing");
  }
}

bool all_valid_in(const std::vector<ShapePtr>& shapes, int dimension) {
  return std::all_of(shapes.begin(), shapes.end(), [&](const ShapePtr& s) { return s->valid_in(dimension); });
}

Face opposite(const Face& face) { return {-face.distance, point::times(-1.0, face.normal)}; }

}  // namespace

Union::Union(Parameters parameters) : shapes_(std::move(parameters.shapes)) {
  require_shapes(shapes_, "a union");
}

const Shape& Union::nearest(const Point& p) const {
  const Shape* best = shapes_.front().get();
  double least = infinity;
  for (const ShapePtr& shape : shapes_) {
    const double distance = shape->signed_distance(p);
    if (distance < least) {
      least = distance;
      best = shape.get();
    }
  }
  return *best;
}

double Union::signed_distance(const Point& p) const {
  double least = infinity;
  for (const ShapePtr& shape : shapes_) least = std::min(least, shape->signed_distance(p));
  return least;
}

Point Union::normal(const Point& p) const { return nearest(p).normal(p); }
Face Union::face(const Point& p) const { return nearest(p).face(p); }
bool Union::distance_is_exact() const { return shapes_.size() == 1 && shapes_.front()->distance_is_exact(); }
bool Union::valid_in(int dimension) const { return all_valid_in(shapes_, dimension); }

bool Union::holds(const Point& p, double tolerance) const {
  return std::any_of(shapes_.begin(), shapes_.end(),
                     [&](const ShapePtr& s) { return s->contains(p, tolerance); });
}

Box Union::bounds() const {
  Box hull{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const ShapePtr& shape : shapes_) {
    const Box box = shape->bounds();
    for (std::size_t a = 0; a < 3; ++a) {
      hull.lower[a] = std::min(hull.lower[a], box.lower[a]);
      hull.upper[a] = std::max(hull.upper[a], box.upper[a]);
    }
  }
  return hull;
}

Intersection::Intersection(Parameters parameters) : shapes_(std::move(parameters.shapes)) {
  require_shapes(shapes_, "an intersection");
}

double Intersection::signed_distance(const Point& p) const {
  double most = -infinity;
  for (const ShapePtr& shape : shapes_) most = std::max(most, shape->signed_distance(p));
  return most;
}

Point Intersection::normal(const Point& p) const {
  const Shape* furthest = shapes_.front().get();
  double most = -infinity;
  for (const ShapePtr& shape : shapes_) {
    const double distance = shape->signed_distance(p);
    if (distance > most) {
      most = distance;
      furthest = shape.get();
    }
  }
  return furthest->normal(p);
}

Face Intersection::face(const Point& p) const {
  Face nearest = shapes_.front()->face(p);
  for (std::size_t i = 1; i < shapes_.size(); ++i) {
    const Face other = shapes_[i]->face(p);
    if (other.distance > nearest.distance) nearest = other;
  }
  return nearest;
}

bool Intersection::distance_is_exact() const {
  return shapes_.size() == 1 && shapes_.front()->distance_is_exact();
}
bool Intersection::valid_in(int dimension) const { return all_valid_in(shapes_, dimension); }

bool Intersection::holds(const Point& p, double tolerance) const {
  return std::all_of(shapes_.begin(), shapes_.end(),
                     [&](const ShapePtr& s) { return s->contains(p, tolerance); });
}

Box Intersection::bounds() const {
  Box common;
  for (const ShapePtr& shape : shapes_) {
    const Box box = shape->bounds();
    for (std::size_t a = 0; a < 3; ++a) {
      common.lower[a] = std::max(common.lower[a], box.lower[a]);
      common.upper[a] = std::min(common.upper[a], box.upper[a]);
    }
  }
  return common;
}

Difference::Difference(Parameters parameters)
    : from_(std::move(parameters.from)), removed_(std::move(parameters.removed)) {
  require_shapes({from_, removed_}, "a difference");
}

double Difference::signed_distance(const Point& p) const {
  return std::max(from_->signed_distance(p), -removed_->signed_distance(p));
}

Point Difference::normal(const Point& p) const {
  if (from_->signed_distance(p) >= -removed_->signed_distance(p)) return from_->normal(p);
  return point::times(-1.0, removed_->normal(p));
}

Face Difference::face(const Point& p) const {
  // By the face of the shape that is cut, not by its distance: a tank with a hole still faces its inside.
  const Face own = from_->face(p);
  const Face cut = opposite({removed_->signed_distance(p), removed_->normal(p)});
  return cut.distance > own.distance ? cut : own;
}

bool Difference::valid_in(int dimension) const {
  return from_->valid_in(dimension) && removed_->valid_in(dimension);
}

bool Difference::holds(const Point& p, double tolerance) const {
  return from_->contains(p, tolerance) && !removed_->contains(p, tolerance);
}

Shell::Shell(Parameters parameters) : of_(std::move(parameters.of)), placement_(parameters.placement) {
  require_shapes({of_}, "a shell");
  const double thickness = parameters.thickness;
  if (!(std::isfinite(thickness) && thickness > 0.0)) {
    std::ostringstream out;
    out << "the thickness of a shell must be positive, but is " << thickness;
    throw std::invalid_argument(out.str());
  }
  const double share_outside = placement_ == Placement::outside  ? 1.0
                               : placement_ == Placement::inside ? 0.0
                                                                 : 0.5;
  outer_ = grown(of_, share_outside * thickness);
  inner_ = grown(of_, -(1.0 - share_outside) * thickness);
}

double Shell::signed_distance(const Point& p) const {
  return std::max(outer_->signed_distance(p), -inner_->signed_distance(p));
}

Point Shell::normal(const Point& p) const {
  if (outer_->signed_distance(p) >= -inner_->signed_distance(p)) return outer_->normal(p);
  return point::times(-1.0, inner_->normal(p));
}

Face Shell::face(const Point& p) const {
  if (placement_ == Placement::centred) return {signed_distance(p), normal(p)};
  const Face own{of_->signed_distance(p), of_->normal(p)};
  return placement_ == Placement::outside ? opposite(own) : own;
}

bool Shell::holds(const Point& p, double tolerance) const {
  return outer_->contains(p, tolerance) && !inner_->contains(p, tolerance);
}

}  // namespace shoal::kernel
