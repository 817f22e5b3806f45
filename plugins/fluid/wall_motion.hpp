// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// fluid.wall_motion: walls that move as rigid bodies along a given path,
//   x(t) = c + s(t) + R(theta(t)) (X - c),
// X being the position at the start, s the translation, theta the rotation about the point c (in 3D about an axis
// through it). Piston and flap wave makers, rolling tanks, stirrers. Velocities are differences of positions over one
// acoustic step, so that they fit the path whatever it is; a jump of the path is a blow.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"

namespace shoal::fluid {

// Path of a file that exists.
struct DataFile {
  std::string path;
};

}  // namespace shoal::fluid

namespace shoal::impl {
template <>
struct ValueTraits<shoal::fluid::DataFile> {
  static constexpr std::uint32_t kind = SHOAL_FILE;
  static shoal::fluid::DataFile get(const shoal_value& v, std::uint32_t k, int) { return {v.texts[k]}; }
};
}  // namespace shoal::impl

namespace shoal::fluid {

// Columns over time, with continuous slopes in between (cubic Hermite, slopes by central differences); constant beyond
// the ends. Rows of numbers, time first; what is no number (headers, comments) is passed over.
class MotionTable {
 public:
  MotionTable() = default;
  explicit MotionTable(const std::string& path);
  MotionTable(std::vector<double> times, std::vector<std::vector<double>> columns);
  std::size_t n_columns() const { return columns_.size(); }
  double value(std::size_t column, double time) const;

 private:
  void check(const std::string& path) const;
  double slope(std::size_t column, std::size_t row) const;
  std::vector<double> times_;
  std::vector<std::vector<double>> columns_;
};

struct Pose {
  std::array<double, 3> translation{};
  double angle = 0;
};

struct Motion {
  VectorExpression translation;
  Expression rotation;
  MotionTable table;
  std::array<double, 3> centre{}, axis{0, 0, 1};
  int dimensions = 2;

  Pose pose(double time) const;
};

// Rodrigues' formula about `axis` (a unit vector); in 2D that is z.
template <int D>
Vec<D> rotated(const Vec<D>& x, const std::array<double, 3>& axis, double angle) {
  Vec<3> v{};
  for (int a = 0; a < D; ++a) v[a] = x[a];
  const Vec<3> n{axis[0], axis[1], axis[2]};
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const Vec<3> turned = cosine * v + sine * cross(n, v) + ((1.0 - cosine) * dot(n, v)) * n;
  Vec<D> out{};
  for (int a = 0; a < D; ++a) out[a] = turned[a];
  return out;
}

// Keeps the normals of the start.
struct KeepNormals : ParticleOperator<KeepNormals> {
  In<Vector> normal{"normal"};
  Out<Vector> reference_normal{"reference_normal", unit("1"), doc("Normal at the start.")};
  void particle(auto i) const { reference_normal[i] = normal[i]; }
};

// Puts the wall where it is after `share` of the acoustic step.
struct MoveWall : ParticleOperator<MoveWall> {
  In<Vector> reference_position{"reference_position"};
  In<Vector> reference_normal{"reference_normal", unit("1"), doc("Normal at the start.")};
  Out<Vector> position{"position"};
  Out<Vector> velocity{"velocity"};
  Out<Vector> normal{"normal"};

  std::shared_ptr<const Motion> motion;
  double share = 1.0;

  void begin() {
    const double now = time() + share * dt();
    before_ = motion->pose(now - 0.5 * dt());
    now_ = motion->pose(now);
    after_ = motion->pose(now + 0.5 * dt());
  }
  void particle(auto i) const {
    const auto place = [&](const Pose& pose) {
      auto x = reference_position[i];
      for (int a = 0; a < i.dimensions; ++a) x[a] -= motion->centre[static_cast<std::size_t>(a)];
      x = rotated(x, motion->axis, pose.angle);
      for (int a = 0; a < i.dimensions; ++a)
        x[a] += motion->centre[static_cast<std::size_t>(a)] + pose.translation[static_cast<std::size_t>(a)];
      return x;
    };
    position[i] = place(now_);
    velocity[i] = (1.0 / dt()) * (place(after_) - place(before_));
    normal[i] = rotated(reference_normal[i], motion->axis, now_.angle);
  }

 private:
  Pose before_, now_, after_;
};

struct WallMotion final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Walls that move together.", example("[flap]")};
  Param<VectorExpression> translation{"translation", "m", "Displacement as expressions of t.", optional,
                                      example("[\"0.05*sin(3*t)\", 0]")};
  Param<Expression> rotation{"rotation", "rad", "Angle as an expression of t.", optional,
                             example("\"0.07*sin(3.8*t)\"")};
  Param<Vector3> centre{"centre", "m", "Point about which it turns.", optional, example("[0.45, 0]")};
  Param<Vector3> axis{"axis", "1", "Axis about which it turns, in 3D.", optional, example("[0, 1, 0]")};
  Param<DataFile> table{
      "table", nullptr,
      "Instead of expressions: a table (CSV) of times in s, displacements in m along each axis, and "
      "angles in rad.",
      optional, example("roll.csv")};

  void build(const Builder& builder);
};

}  // namespace shoal::fluid
