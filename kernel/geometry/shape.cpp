// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a shape gets for nothing from its signed distance alone.
#include "shape.hpp"

#include <stdexcept>

namespace shoal::kernel {
namespace {

/// The set of points within `distance` of a shape (beyond -distance inside it, where negative).
class Offset final : public Shape {
 public:
  Offset(ShapePtr of, double distance) : of_(std::move(of)), distance_(distance) {}
  double signed_distance(const Point& p) const override { return of_->signed_distance(p) - distance_; }
  Point normal(const Point& p) const override { return of_->normal(p); }
  Box bounds() const override {
    Box box = of_->bounds();
    for (std::size_t a = 0; a < 3; ++a) {
      box.lower[a] -= distance_;
      box.upper[a] += distance_;
    }
    return box;
  }
  bool distance_is_exact() const override { return of_->distance_is_exact(); }
  bool valid_in(int dimension) const override { return of_->valid_in(dimension); }

 private:
  bool holds(const Point& p, double tolerance) const override {
    return signed_distance(point::along(p, tolerance, point::upper_side)) < 0.0;
  }

  ShapePtr of_;
  double distance_;
};

/// The length over which the distance of a shape may be expected to be smooth.
double length_scale(const Box& box, const Point& p) {
  double scale = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double side = box.upper[a] - box.lower[a];
    if (std::isfinite(side)) scale = std::max(scale, side);
    scale = std::max(scale, std::abs(p[a]));
  }
  return scale > 0.0 ? scale : 1.0;
}

Point central_difference(const Shape& shape, const Point& p, double step) {
  Point gradient{};
  for (std::size_t a = 0; a < 3; ++a) {
    Point ahead = p;
    Point behind = p;
    ahead[a] += step;
    behind[a] -= step;
    gradient[a] = (shape.signed_distance(ahead) - shape.signed_distance(behind)) / (2.0 * step);
  }
  return gradient;
}

}  // namespace

Point Shape::normal(const Point& p) const {
  // On a ridge of the distance the differences cancel. A step aside, along a direction that no symmetric
  // shape is likely to have as a symmetry, reaches the smooth part next to it.
  const double step = 1e-6 * length_scale(bounds(), p);
  const Point aside{0.8017837257372732, 0.5345224838248488, 0.2672612419124244};
  Point from = p;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const Point gradient = central_difference(*this, from, step);
    if (point::length(gradient) > 0.1) return point::unit(gradient, {1.0, 0.0, 0.0});
    from = point::along(p, 4.0 * step * std::pow(4.0, attempt), aside);
  }
  return {1.0, 0.0, 0.0};
}

bool Shape::holds(const Point& p, double tolerance) const { return signed_distance(p) <= tolerance; }

ShapePtr Shape::grown_sharply(double /*distance*/) const { return nullptr; }

ShapePtr grown(const ShapePtr& shape, double distance) {
  if (!shape) throw std::invalid_argument("there is no shape to grow");
  if (!std::isfinite(distance)) throw std::invalid_argument("the distance to grow a shape by must be finite");
  if (distance == 0.0) return shape;
  if (ShapePtr sharp = shape->grown_sharply(distance)) return sharp;
  return std::make_shared<Offset>(shape, distance);
}

}  // namespace shoal::kernel
