// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a body is: shapes described by their signed distance, so that one description serves to fill a body
// with particles, to give its surface normals, to grow a wall around it and to keep particles inside while
// they relax.
//
// Two rules hold for every shape, also for those that other code derives from Shape:
//  - signed_distance() is negative inside and never larger in magnitude than the true distance to the surface
//    (its Lipschitz constant is one). The lattice generator strides over whole rows on the strength of that.
//  - a shape that does not depend on z (a box or polygon for two dimensions) is an infinite prism along z, so
//  that
//    the same object answers in two and in three dimensions.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "point.hpp"

namespace shoal::kernel {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// An axis-aligned box; any side may be infinite. Empty where lower > upper.
struct Box {
  Point lower{-infinity, -infinity, -infinity};
  Point upper{infinity, infinity, infinity};
};

/// The surface that a point of a body looks at: see Shape::face().
struct Face {
  double distance = 0.0;  ///< negative behind the face, that is within the body
  Point normal{};         ///< unit, out of the body
};

class Shape;
using ShapePtr = std::shared_ptr<const Shape>;

class Shape {
 public:
  Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  virtual ~Shape() = default;

  /// Distance to the surface, negative inside. Exact where distance_is_exact(), else a lower bound of its
  /// magnitude with the exact sign.
  [[nodiscard]] virtual double signed_distance(const Point& p) const = 0;

  /// Outward unit gradient of the distance. Where the gradient has no single value (edges, the middle of a
  /// ball) a unit vector of one of its neighbours, or their mean. Central differences unless a shape knows
  /// better.
  [[nodiscard]] virtual Point normal(const Point& p) const;

  /// Box around the shape; infinite along axes where the shape does not end.
  [[nodiscard]] virtual Box bounds() const = 0;

  /// Whether the shape holds the point. A point within `tolerance` of the surface counts as on it, which
  /// makes the answer independent of rounding. Of flat faces a shape holds those on its lower side (towards
  /// -x, then -y, -z), so that shapes side by side share no point and lose none; round surfaces are held all
  /// around. What a difference removes is exactly what the removed shape holds.
  [[nodiscard]] bool contains(const Point& p, double tolerance = 0.0) const { return holds(p, tolerance); }

  /// False where signed_distance() is a bound only (booleans, unequal scaling).
  [[nodiscard]] virtual bool distance_is_exact() const { return true; }

  /// Whether the shape has a meaning in so many dimensions (a cylinder has none in two).
  [[nodiscard]] virtual bool valid_in(int dimension) const { return dimension == 2 || dimension == 3; }

  /// The surface that a wall made of this shape turns to what it touches. For most shapes that is the nearest
  /// surface. For a shell it is the surface of the shape that it lines, even for points nearer to its back.
  [[nodiscard]] virtual Face face(const Point& p) const { return {signed_distance(p), normal(p)}; }

  /// The shape grown by `distance` (shrunk where negative) with its sharp edges kept, or null where the shape
  /// knows no better than to offset its distance. grown() below chooses.
  [[nodiscard]] virtual ShapePtr grown_sharply(double distance) const;

 private:
  [[nodiscard]] virtual bool holds(const Point& p, double tolerance) const;
};

/// The shape grown by `distance`, or shrunk where negative: sharply if the shape can (boxes, cylinders, half
/// spaces, also when turned), else by offsetting its distance, which rounds convex edges.
[[nodiscard]] ShapePtr grown(const ShapePtr& shape, double distance);

/// Axis-aligned box. In two dimensions z is not looked at. Sides may be infinite.
class BoxShape final : public Shape {
 public:
  struct Parameters {
    Point lower{};
    Point upper{};
    int dimension = 3;
  };
  explicit BoxShape(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override { return box_; }
  [[nodiscard]] ShapePtr grown_sharply(double distance) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  Box box_;
  int dimension_;
};

/// Ball; a disc in two dimensions.
class Ball final : public Shape {
 public:
  struct Parameters {
    Point centre{};
    double radius = 0.0;
  };
  explicit Ball(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] ShapePtr grown_sharply(double distance) const override;

 private:
  Parameters ball_;
};

/// Round cylinder with flat ends at `from` and `to`. Three dimensions only.
class Cylinder final : public Shape {
 public:
  struct Parameters {
    Point from{};
    Point to{};
    double radius = 0.0;
  };
  explicit Cylinder(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] bool valid_in(int dimension) const override { return dimension == 3; }
  [[nodiscard]] ShapePtr grown_sharply(double distance) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  struct Section;  // the point in the plane through the axis
  [[nodiscard]] Section section(const Point& p) const;
  Parameters cylinder_;
  Point axis_{};
  double half_length_ = 0.0;
  Point middle_{};
};

/// All points behind the plane through `point`: inside is where (p - point) . normal < 0. The normal points
/// out of the shape and need not be of unit length.
class HalfSpace final : public Shape {
 public:
  struct Parameters {
    Point point{};
    Point normal{};
  };
  explicit HalfSpace(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] ShapePtr grown_sharply(double distance) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  Parameters plane_;
};

/// Simple polygon in the x-y plane, in either orientation, convex or not; a prism along z. The first vertex
/// need not be repeated at the end (it is dropped if it is). A query costs one pass over the vertices.
class Polygon final : public Shape {
 public:
  struct Parameters {
    std::vector<Point> vertices;
  };
  explicit Polygon(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override { return bounds_; }
  [[nodiscard]] double area() const { return area_; }

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  struct Nearest;
  [[nodiscard]] Nearest nearest(const Point& p) const;
  [[nodiscard]] Point edge_normal(std::size_t edge) const;
  std::vector<Point> vertices_;  // counter-clockwise
  Box bounds_;
  double area_ = 0.0;
};

/// Everything that at least one of the shapes holds. The distance is exact outside, a bound inside.
class Union final : public Shape {
 public:
  struct Parameters {
    std::vector<ShapePtr> shapes;
  };
  explicit Union(Parameters parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] bool distance_is_exact() const override;
  [[nodiscard]] bool valid_in(int dimension) const override;
  [[nodiscard]] Face face(const Point& p) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  [[nodiscard]] const Shape& nearest(const Point& p) const;
  std::vector<ShapePtr> shapes_;
};

/// What all of the shapes hold. The distance is exact inside, a bound outside.
class Intersection final : public Shape {
 public:
  struct Parameters {
    std::vector<ShapePtr> shapes;
  };
  explicit Intersection(Parameters parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] bool distance_is_exact() const override;
  [[nodiscard]] bool valid_in(int dimension) const override;
  [[nodiscard]] Face face(const Point& p) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  std::vector<ShapePtr> shapes_;
};

/// `from` without what `removed` holds. The distance is a bound with the exact sign.
class Difference final : public Shape {
 public:
  struct Parameters {
    ShapePtr from;
    ShapePtr removed;
  };
  explicit Difference(Parameters parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override { return from_->bounds(); }
  [[nodiscard]] bool distance_is_exact() const override { return false; }
  [[nodiscard]] bool valid_in(int dimension) const override;
  [[nodiscard]] Face face(const Point& p) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  ShapePtr from_;
  ShapePtr removed_;
};

/// The layer along the surface of a shape. Around a box or cylinder it has sharp corners, full of lattice
/// points (the box grown minus the box); around other shapes it is the set of points within `thickness`. The
/// distance is exact where that of the shape is.
class Shell final : public Shape {
 public:
  enum class Placement { outside, inside, centred };
  struct Parameters {
    ShapePtr of;
    double thickness = 0.0;
    Placement placement = Placement::outside;
  };
  explicit Shell(Parameters parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override { return outer_->bounds(); }
  [[nodiscard]] bool distance_is_exact() const override { return of_->distance_is_exact(); }
  [[nodiscard]] bool valid_in(int dimension) const override { return of_->valid_in(dimension); }
  /// Outside shell: the surface towards the shape that it encloses. Inside shell: the surface of the shape
  /// itself. Centred: the nearest.
  [[nodiscard]] Face face(const Point& p) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  ShapePtr of_;
  Placement placement_;
  ShapePtr outer_;
  ShapePtr inner_;
};

/// A shape scaled, then turned about `axis`, both about `centre`, then moved. Unequal scales make the
/// distance a bound (that of the shape times the smallest scale); in two dimensions only the scales of x and
/// y count.
class Transform final : public Shape {
 public:
  struct Parameters {
    ShapePtr of;
    Point scale{1.0, 1.0, 1.0};
    Point axis{0.0, 0.0, 1.0};
    double angle = 0.0;  ///< radians, right-handed about the axis
    Point centre{};
    Point translation{};
    int dimension = 3;
  };
  explicit Transform(const Parameters& parameters);
  [[nodiscard]] double signed_distance(const Point& p) const override;
  [[nodiscard]] Point normal(const Point& p) const override;
  [[nodiscard]] Box bounds() const override;
  [[nodiscard]] bool distance_is_exact() const override;
  [[nodiscard]] bool valid_in(int dimension) const override;
  [[nodiscard]] Face face(const Point& p) const override;
  [[nodiscard]] ShapePtr grown_sharply(double distance) const override;

 private:
  [[nodiscard]] bool holds(const Point& p, double tolerance) const override;
  [[nodiscard]] Point to_shape(const Point& p) const;
  [[nodiscard]] Point direction_from_shape(const Point& n) const;
  [[nodiscard]] bool scales_equally() const;
  Parameters parameters_;
  std::array<Point, 3> rotation_{};  // rows
  double smallest_scale_ = 1.0;
};

}  // namespace shoal::kernel
