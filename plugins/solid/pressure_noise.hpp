// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How far the pressure of a particle is from what its neighbours say: p_i less the value at i of the linear function that
// fits theirs best, by least squares with weights V_j W_ij of the reference configuration,
//   noise_i = p_i - a,   a, b minimise sum_j V_j W_ij (p_j - a - b . (X_j - X_i))^2.
// Where pressure alternates by +-A from particle to particle it is of the size of A; where pressure is smooth it is
// dx^2 times second derivatives of p, so it falls to a quarter with half the spacing. As a measure of a checkerboard
// take the root of the mean of pressure_noise^2 over that of pressure^2.
#pragma once

#include <Eigen/Dense>

#include "monomials.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "structure.hpp"

namespace shoal::solid {

struct PressureNoise : ReferenceOperator {
  In<Vector> reference_position{"reference_position"};
  In<Scalar> volume{"volume"};
  In<Scalar> pressure{"pressure"};
  Out<Scalar> noise{"pressure_noise", unit("Pa"),
                    doc("Pressure less the value of a linear fit of that of the neighbours."), derived};

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const WendlandC2<D> kernel(structure->settings.smoothing_length);
    for (std::uint64_t k = chunk.begin; k < chunk.end; ++k)
      noise[Particle<D>{k, nullptr}] = noise_of(Particle<D>{k, nullptr}, kernel);
  }

 private:
  // Zero where the neighbours do not span the space.
  template <int D>
  double noise_of(Particle<D> i, const WendlandC2<D>& kernel) const {
    using Column = Eigen::Matrix<double, D + 1, 1>;
    Eigen::Matrix<double, D + 1, D + 1> moments = Eigen::Matrix<double, D + 1, D + 1>::Zero();
    Column right = Column::Zero();
    const Row row = row_of(neighbours(0), i.index);
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const Particle<D> j{row.j[m], nullptr};
      const Vec<D> X = reference_position[j] - reference_position[i];
      Column p;
      p[0] = 1.0;
      for (int a = 0; a < D; ++a) p[a + 1] = X[a] / kernel.h();
      const double w = volume[j] * kernel.w(norm(X));
      moments += w * p * p.transpose();
      right += w * (pressure[j] - pressure[i]) * p;
    }
    const Eigen::FullPivLU<Eigen::Matrix<double, D + 1, D + 1>> solver(moments);
    if (!solver.isInvertible()) return 0.0;
    return -solver.solve(right)[0];
  }
};

}  // namespace shoal::solid
