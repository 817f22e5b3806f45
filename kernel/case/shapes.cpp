// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/case/shapes.hpp"

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "kernel/case/own_type.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

using shoal::Choice;
using shoal::ObjectHandle;
using shoal::Param;
using shoal::Parameterised;
using shoal::Vector3;

constexpr ObjectsOf shapes_only{SHOAL_TYPE_SHAPE};

std::vector<ShapePtr> make_all(const std::vector<ObjectHandle>& objects, int dimensions) {
  std::vector<ShapePtr> shapes;
  for (const ObjectHandle& object : objects) shapes.push_back(make_shape(*object.object, dimensions));
  return shapes;
}

struct BoxParameters : Parameterised {
  Param<Vector3> lower{"lower", "m", "Corner with the smallest coordinates.", example("[0, 0]")};
  Param<Vector3> upper{"upper", "m", "Corner with the largest coordinates.", example("[2 m, 1 m]")};
  ShapePtr make(int dimensions) const {
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
      if (!(lower.value()[k] < upper.value()[k]))
        throw std::invalid_argument(
            "the box is empty: its lower corner is not below its upper corner along " +
            std::string(1, "xyz"[k]));
    }
    return std::make_shared<BoxShape>(BoxShape::Parameters{lower, upper, dimensions});
  }
};

struct BallParameters : Parameterised {
  Param<Vector3> centre{"centre", "m", "Centre.", example("[0, 0]")};
  Param<double> radius{"radius", "m", "Radius.", positive, example("0.1 m")};
  ShapePtr make(int) const { return std::make_shared<Ball>(Ball::Parameters{centre, radius}); }
};

struct CylinderParameters : Parameterised {
  Param<Vector3> from{"from", "m", "Middle of one end.", example("[0, 0, 0]")};
  Param<Vector3> to{"to", "m", "Middle of the other end.", example("[0, 0, 1 m]")};
  Param<double> radius{"radius", "m", "Radius.", positive, example("0.1 m")};
  ShapePtr make(int) const { return std::make_shared<Cylinder>(Cylinder::Parameters{from, to, radius}); }
};

struct HalfSpaceParameters : Parameterised {
  Param<Vector3> point{"point", "m", "A point of the plane.", example("[0, 0]")};
  Param<Vector3> normal{"normal", "1", "Normal of the plane, out of the shape; of any length.",
                        example("[0, 1]")};
  ShapePtr make(int) const { return std::make_shared<HalfSpace>(HalfSpace::Parameters{point, normal}); }
};

struct PolygonParameters : Parameterised {
  Param<std::vector<Vector3>> vertices{
      "vertices", "m",
      "Corners in order, either way round. In three dimensions their z is not looked "
      "at: the shape is a prism along z.",
      example("[[0, 0], [1, 0], [1, 1]]")};
  ShapePtr make(int) const {
    Polygon::Parameters polygon;
    for (const Vector3& vertex : vertices.value()) polygon.vertices.push_back({vertex[0], vertex[1], 0.0});
    return std::make_shared<Polygon>(polygon);
  }
};

struct ShellParameters : Parameterised {
  Param<ObjectHandle> of{"of", nullptr, "Shape along whose surface the shell lies.", shapes_only,
                         example("{box: {lower: [0, 0], upper: [2, 1]}}")};
  Param<double> thickness{"thickness", "m", "Thickness.", positive, example("4*dx")};
  Param<Choice> placement{"placement",
                          nullptr,
                          "On which side of the surface.",
                          one_of("outside", "inside", "centred"),
                          default_to("outside"),
                          example("inside")};
  ShapePtr make(int dimensions) const {
    const auto side = placement.value() == "inside"    ? Shell::Placement::inside
                      : placement.value() == "centred" ? Shell::Placement::centred
                                                       : Shell::Placement::outside;
    return std::make_shared<Shell>(Shell::Parameters{make_shape(*of->object, dimensions), thickness, side});
  }
};

struct UnionParameters : Parameterised {
  Param<std::vector<ObjectHandle>> of{"of", nullptr, "Shapes.", shapes_only,
                                      example("[{ball: {centre: [0, 0], radius: 1}}, "
                                              "{box: {lower: [0, 0], upper: [2, 1]}}]")};
  ShapePtr make(int dimensions) const {
    return std::make_shared<Union>(Union::Parameters{make_all(of, dimensions)});
  }
};

struct IntersectionParameters : Parameterised {
  Param<std::vector<ObjectHandle>> of{"of", nullptr, "Shapes.", shapes_only,
                                      example("[{ball: {centre: [0, 0], radius: 1}}, "
                                              "{half_space: {point: [0, 0], normal: [0, 1]}}]")};
  ShapePtr make(int dimensions) const {
    return std::make_shared<Intersection>(Intersection::Parameters{make_all(of, dimensions)});
  }
};

struct DifferenceParameters : Parameterised {
  Param<ObjectHandle> from{"from", nullptr, "Shape from which others are taken away.", shapes_only,
                           example("{box: {lower: [0, 0], upper: [2, 1]}}")};
  Param<std::vector<ObjectHandle>> remove{"remove", nullptr, "Shapes to take away.", shapes_only,
                                          example("[{ball: {centre: [1, 0.5], radius: 0.2}}]")};
  ShapePtr make(int dimensions) const {
    std::vector<ShapePtr> removed = make_all(remove, dimensions);
    const ShapePtr all =
        removed.size() == 1 ? removed[0] : std::make_shared<Union>(Union::Parameters{removed});
    return std::make_shared<Difference>(Difference::Parameters{make_shape(*from->object, dimensions), all});
  }
};

struct TransformParameters : Parameterised {
  Param<ObjectHandle> of{"of", nullptr, "Shape that is scaled, then turned, then moved.", shapes_only,
                         example("{box: {lower: [0, 0], upper: [2, 1]}}")};
  Param<Vector3> scale{"scale", "1", "Factors along the axes.", optional, example("[2, 1]")};
  Param<double> angle{"angle", "rad", "Angle by which it is turned, anticlockwise.", default_to(0.0),
                      example("30 deg")};
  Param<std::vector<double>> axis{"axis", "1", "Axis about which it is turned in three dimensions.",
                                  default_to("[0, 0, 1]"), example("[0, 1, 0]")};
  Param<Vector3> centre{"centre", "m", "Point about which it is scaled and turned; the origin without it.",
                        optional, example("[1, 0.5]")};
  Param<Vector3> move{"move", "m", "Distance by which it is moved.", optional, example("[0.1, 0]")};
  ShapePtr make(int dimensions) const {
    if (axis.value().size() != 3) throw std::invalid_argument("the axis of rotation has three components");
    Transform::Parameters transform;
    transform.of = make_shape(*of->object, dimensions);
    if (scale.is_set()) transform.scale = scale.value();
    if (scale.is_set() && dimensions == 2) transform.scale[2] = 1.0;
    transform.axis = {axis.value()[0], axis.value()[1], axis.value()[2]};
    transform.angle = angle;
    if (centre.is_set()) transform.centre = centre.value();
    if (move.is_set()) transform.translation = move.value();
    transform.dimension = dimensions;
    return std::make_shared<Transform>(transform);
  }
};

// ---------------------------------------------------------------------------------------------------------------
// Both ways in: the kernel makes its own shapes as objects of C++, and the registry holds every type to the C table.

template <class P>
ShapePtr make(const shoal_object& object, int dimensions) {
  P parameters;
  parameters.read(object, dimensions);
  return parameters.make(dimensions);
}

struct Made {
  ShapePtr shape;
};

shoal_status create_c(const shoal_object* object, int32_t dimensions, void** self) {
  return guarded([&] { *self = new Made{make_shape(*object, dimensions)}; });
}
void destroy_c(void* self) { delete static_cast<Made*>(self); }
shoal_status distance_c(void* self, uint64_t n, const double* points, double* distances) {
  return guarded([&] {
    for (uint64_t k = 0; k < n; ++k)
      distances[k] = static_cast<Made*>(self)->shape->signed_distance(
          {points[3 * k], points[3 * k + 1], points[3 * k + 2]});
  });
}
void bounds_c(void* self, double lower[3], double upper[3]) {
  const Box box = static_cast<Made*>(self)->shape->bounds();
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = box.lower[k];
    upper[k] = box.upper[k];
  }
}

using Maker = ShapePtr (*)(const shoal_object&, int);

struct OwnShapes {
  std::vector<const shoal_type*> types;
  std::map<const shoal_type*, Maker> makers;

  template <class P>
  void add(const char* name, const char* doc) {
    static const shoal_shape_api api{sizeof(shoal_shape_api), 0, create_c, destroy_c, distance_c, bounds_c};
    types.push_back(own_type<P>(SHOAL_TYPE_SHAPE, name, doc, &api));
    makers[types.back()] = make<P>;
  }
};

const OwnShapes& own_shapes() {
  static const OwnShapes shapes = [] {
    OwnShapes all;
    shoal::impl::host_table = &plugin_host();
    all.add<BoxParameters>("box", "A box along the axes; a rectangle in two dimensions.");
    all.add<BallParameters>("ball", "A ball; a disc in two dimensions.");
    all.add<CylinderParameters>("cylinder", "A round cylinder with flat ends, in three dimensions.");
    all.add<PolygonParameters>("polygon",
                               "A polygon in the plane of x and y; a prism along z in three dimensions.");
    all.add<HalfSpaceParameters>("half_space", "All points behind a plane, to cut other shapes with.");
    all.add<ShellParameters>("shell", "A layer along the surface of a shape, e.g. the wall around a box.");
    all.add<UnionParameters>("union", "What at least one of the shapes holds.");
    all.add<IntersectionParameters>("intersection", "What all of the shapes hold.");
    all.add<DifferenceParameters>("difference", "A shape without what others hold.");
    all.add<TransformParameters>("transform", "A shape that is scaled, turned and moved.");
    return all;
  }();
  return shapes;
}

// ---------------------------------------------------------------------------------------------------------------

class PluginShape final : public Shape {
 public:
  PluginShape(const shoal_object& object, int dimensions)
      : type_(object.type->name), api_(abi_copy(static_cast<const shoal_shape_api*>(object.type->api))) {
    call_plugin(plugin(), type_, [&] { return api_.create(&object, dimensions, &self_); });
  }
  ~PluginShape() override {
    if (api_.destroy != nullptr) api_.destroy(self_);
  }
  double signed_distance(const Point& p) const override {
    double distance = 0.0;
    call_plugin(plugin(), type_, [&] { return api_.distance(self_, 1, p.data(), &distance); });
    return distance;
  }
  Box bounds() const override {
    Box box;
    api_.bounds(self_, box.lower.data(), box.upper.data());
    return box;
  }
  bool distance_is_exact() const override { return false; }

 private:
  std::string plugin() const { return type_.substr(0, type_.find('.')); }
  std::string type_;
  shoal_shape_api api_;
  void* self_ = nullptr;
};

}  // namespace

const std::vector<const shoal_type*>& own_shape_types() { return own_shapes().types; }

ShapePtr make_shape(const shoal_object& object, int dimensions) {
  const auto own = own_shapes().makers.find(object.type);
  if (own == own_shapes().makers.end()) return std::make_shared<PluginShape>(object, dimensions);
  ShapePtr shape;
  try {
    shape = own->second(object, dimensions);
  } catch (const std::invalid_argument& error) {
    throw ModelError(error.what(), object.place);
  }
  if (!shape->valid_in(dimensions))
    throw ModelError("the shape '" + std::string(object.type->name) + "' has no meaning in " +
                         std::to_string(dimensions) + " dimensions",
                     object.place);
  return shape;
}

}  // namespace shoal::kernel
