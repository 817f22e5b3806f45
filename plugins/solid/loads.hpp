// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads, all added to `acceleration` at the middle of the step.
//
// Surface loads act on the area vectors A_i N_i of the reference configuration that the discrete equations themselves
// contain: a uniform stress P gives particle i the force V_i P r_i, r_i = sum_j (G_ij - V_j / V_i G_ji), so with
//   A_i N_i = -V_i r_i
// a body under uniform stress and the traction P N that belongs to it is in equilibrium to rounding, on any
// arrangement of particles. Area vectors lie in the layers of particles within the support of the surface.
//   traction    f_i = t (A_i N_i . N),  N the mean normal of the region; t per reference area, in a fixed direction
//   pressure    f_i = -p J F^-T A_i N_i, follows the deformed surface (Nanson)
#pragma once

#include <array>
#include <string>
#include <vector>

#include "region.hpp"
#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

struct Gravity : ParticleOperator<Gravity> {
  Accumulate<Vector> acceleration{"acceleration"};
  Vector3 gravity{};

  void particle(auto i) const {
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      acceleration[i][a] += gravity[static_cast<std::size_t>(a)];
  }
};

// The area vectors, once.
struct SurfaceArea : WeightBuilder {
  Out<Vector> area{"reference_area", unit("m2"), doc("Outward area vector of the reference configuration.")};

  void begin() { build_weights(); }
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    for (std::uint64_t k = chunk.begin; k < chunk.end; ++k) {
      const Particle<D> i{k, nullptr};
      structure->weights.residual(k, area[i].e);
      area[i] *= -volume[i];
    }
  }
};

struct TractionLoad : ParticleOperator<TractionLoad> {
  In<Vector> reference_position{"reference_position"};
  In<Vector> area{"reference_area", unit("m2"), doc("Outward area vector of the reference configuration.")};
  In<Scalar> mass{"mass"};
  Accumulate<Vector> acceleration{"acceleration"};

  RegionValues loaded;
  VectorExpression traction;  // Pa; or N where `total`
  bool total = false;         // the face takes this force, in proportion to area

  void begin();
  void particle(auto i) const {
    if (!loaded.holds(i.index)) return;
    double along = 0;
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      along += area[i][a] * normal_[static_cast<std::size_t>(a)];
    if (total) along /= face_;
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      acceleration[i][a] += along / mass[i] * value_[static_cast<std::size_t>(a)][i.index];
  }

 private:
  Vector3 normal_{};
  double face_ = 0;  // area, m2
  std::array<std::vector<double>, 3> value_;
};

struct PressureLoad : ParticleOperator<PressureLoad> {
  In<Vector> reference_position{"reference_position"};
  In<Vector> area{"reference_area", unit("m2"), doc("Outward area vector of the reference configuration.")};
  In<Matrix> F{"deformation_gradient"};
  In<Scalar> mass{"mass"};
  Accumulate<Vector> acceleration{"acceleration"};

  RegionValues loaded;
  Expression pressure;

  void begin();
  void particle(auto i) const {
    if (!loaded.holds(i.index)) return;
    const auto deformed = determinant(F[i]) * (transpose(inverse(F[i])) * area[i]);
    acceleration[i] -= value_[i.index] / mass[i] * deformed;
  }

 private:
  std::vector<double> value_;
};

// A force spread over the particles around a point of the reference configuration.
struct PointForceLoad : ParticleOperator<PointForceLoad> {
  In<Vector> reference_position{"reference_position"};
  In<Scalar> mass{"mass"};
  Accumulate<Vector> acceleration{"acceleration"};

  Vector3 point{};
  double radius = 0;  // m
  std::string place;  // in the case, for messages
  VectorExpression force;

  void begin();
  void particle(auto i) const {
    if (share_[i.index] == 0.0) return;
    for (int a = 0; a < decltype(i)::dimensions; ++a)
      acceleration[i][a] += share_[i.index] / mass[i] * value_[static_cast<std::size_t>(a)];
  }

 private:
  std::vector<double> share_;  // of the force, for each particle
  Vector3 value_{};
};

// A torque about the axis through the centre of mass of a region: accelerations like those of a rigid body.
struct TorqueLoad : ParticleOperator<TorqueLoad> {
  In<Vector> reference_position{"reference_position"};
  In<Vector> position{"position"};
  In<Scalar> mass{"mass"};
  Accumulate<Vector> acceleration{"acceleration"};

  RegionValues loaded;
  Vector3 axis{0, 0, 1};  // of length one
  Expression torque;

  void begin();
  void particle(auto i) const {
    if (!loaded.holds(i.index)) return;
    constexpr int D = decltype(i)::dimensions;
    Vec<3> r{};
    for (int a = 0; a < D; ++a) r[a] = position[i][a] - centre_[static_cast<std::size_t>(a)];
    const Vec<3> w = cross(Vec<3>{axis[0], axis[1], axis[2]}, r);
    for (int a = 0; a < D; ++a) acceleration[i][a] += angular_acceleration_ * w[a];
  }

 private:
  Vector3 centre_{};
  double angular_acceleration_ = 0;  // 1/s2
};

}  // namespace shoal::solid
