// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Coefficients of diffusion with which waves of a reaction have their right speed although the particles do not resolve
// the front. A plane wave of dy/dt = D d2y/dx2 + f(y) runs at c = sqrt(D) c_f. On particles of spacing dx it is slower,
// c_dx(D): its front is sqrt(D) times a length of the model's own, and where dx is not small against that, the front
// moves from particle to particle in jumps. Along each axis of the tensor D is raised to the D' with
//   c_dx(D') = sqrt(D) c_f
// Both speeds are those of waves on a line (cable.hpp), c_dx with the weights of the scheme on the lattice of the
// initial spacing, c_f extrapolated from two fine lines. D' - D vanishes with dx^2, so the limit of the scheme stays
// what it is. What is corrected is the plane wave along the axes; where the front is curved, D' - D acts as an error of
// its own, which is why it is no substitute for resolution. Meshes of finite elements are treated in the same way in
// practice (conductivities tuned to a velocity: Costa et al. 2013).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "cable.hpp"
#include "shoal/abi.h"
#include "shoal/vec.hpp"

namespace shoal::diffusion {

using AxisValues = std::array<double, 3>;  // along the axes of a tensor; in 2D the third is 0

class WaveSpeedCorrection {
 public:
  // Weights of the scheme on a line along axis a of tensors with these values on their axes, 1/s.
  using LineWeights = std::function<std::vector<double>(const AxisValues& d, std::size_t axis)>;

  // `model`: the object of a reaction model. Throws CaseError if its waves cannot be found.
  WaveSpeedCorrection(const shoal_object& model, int dimensions, double spacing, LineWeights weights);
  ~WaveSpeedCorrection();

  // D' of a tensor with these values on its axes, m2/s. [any thread]
  AxisValues operator()(const AxisValues& d) const;
  // D' of an isotropic coefficient, and of a symmetric tensor.
  double operator()(double d) const { return (*this)(AxisValues{d, d, dimensions_ == 3 ? d : 0.0})[0]; }
  template <int D>
  Mat<D> operator()(const Mat<D>& tensor) const;

 private:
  class Waves;
  AxisValues corrected(const AxisValues& d) const;
  double corrected(const AxisValues& d, const AxisValues& guess, std::size_t axis) const;

  int dimensions_;
  double spacing_;
  LineWeights weights_;
  std::unique_ptr<const Waves> waves_;
  std::string place_;
  mutable std::mutex mutex_;
  mutable std::map<AxisValues, AxisValues> known_;
};

}  // namespace shoal::diffusion
