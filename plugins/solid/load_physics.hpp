// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads as a case names them.
#pragma once

#include "shoal/physics.hpp"

namespace shoal::solid {

// Which particles: a condition on the reference position, a shape, or both.
struct RegionPhysics : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies.", example("[beam]")};
  Param<Expression> where{"where", "1",
                          "Condition on the reference position (x, y, z) that the particles meet.", optional,
                          example("x > L - 3*dx")};
  Param<ObjectHandle> within{"within",
                             nullptr,
                             "Shape that holds the particles.",
                             ObjectsOf{SHOAL_TYPE_SHAPE},
                             optional,
                             example("{ball: {centre: [0, 0], radius: 0.1}}")};
};

struct Traction final : RegionPhysics {
  Param<VectorExpression> traction{
      "traction", "Pa",
      "Force per reference area as expressions of the reference position and t; its "
      "direction stays. It acts on the face of the region's mean normal: the region is the "
      "particles within 5 spacings of one flat face whose neighbours stand at right angles.",
      optional, example("[0, \"1e5*min(t, 1)\"]")};
  Param<VectorExpression> force{
      "force", "N",
      "Instead, the force on the whole region, spread over its surface; per metre of depth in "
      "two dimensions. Right where neighbouring faces are slanted.",
      optional, example("[0, 100]")};
  void build(const Builder& builder);
};

struct Pressure final : RegionPhysics {
  Param<Expression> pressure{
      "pressure", "Pa",
      "Pressure on the surface of the region, along its current normal, as an expression of "
      "the reference position and t.",
      example("\"1e5*min(t, 1)\"")};
  void build(const Builder& builder);
};

struct PointForce final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Solid bodies.", example("[beam]")};
  Param<Vector3> at{"at", "m", "Point of the reference configuration.", example("[1, 0]")};
  Param<VectorExpression> force{"force", "N",
                                "Force as expressions of t; in two dimensions per metre of depth.",
                                example("[0, \"10*t\"]")};
  Param<double> radius{"radius", "1", "Radius over which it is spread, in spacings.", positive,
                       default_to(2.0)};
  void build(const Builder& builder);
};

struct Torque final : RegionPhysics {
  Param<Expression> torque{"torque", "N m",
                           "Torque as an expression of t; in two dimensions per metre of depth.",
                           example("\"5*t\"")};
  Param<std::vector<double>> axis{"axis", "1", "Direction of the axis, in three dimensions.",
                                  default_to("[0, 0, 1]"), example("[1, 0, 0]")};
  void build(const Builder& builder);
};

}  // namespace shoal::solid
