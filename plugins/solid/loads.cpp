// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "loads.hpp"

#include <algorithm>
#include <cmath>

namespace shoal::solid {

void TractionLoad::begin() {
  const auto d = static_cast<std::size_t>(dimensions());
  if (!loaded.looked()) {
    loaded.look(dimensions(), n_particles(), reference_position.data());
    for (std::size_t a = 0; a < d; ++a) value_[a].assign(n_particles(), 0.0);
    for (const std::uint64_t i : loaded.particles())
      for (std::size_t a = 0; a < d; ++a) normal_[a] += area.data()[i * d + a];
    face_ = std::hypot(normal_[0], normal_[1], normal_[2]);
    if (!(face_ > 1e-6 * std::pow(spacing(), dimensions() - 1)))
      throw CaseError(loaded.region.place +
                      ": the region of the traction holds no surface; it is the particles within 5 spacings "
                      "of one flat face");
    for (double& component : normal_) component /= face_;
  }
  for (std::size_t a = 0; a < d; ++a)
    loaded.evaluate(traction.component[a], dimensions(), time() + 0.5 * dt(), value_[a]);
}

void PressureLoad::begin() {
  if (!loaded.looked()) {
    loaded.look(dimensions(), n_particles(), reference_position.data());
    value_.assign(n_particles(), 0.0);
  }
  loaded.evaluate(pressure, dimensions(), time() + 0.5 * dt(), value_);
}

void PointForceLoad::begin() {
  const auto d = static_cast<std::size_t>(dimensions());
  if (share_.empty()) {
    share_.assign(n_particles(), 0.0);
    double sum = 0;
    for (std::uint64_t i = 0; i < n_particles(); ++i) {
      double square = 0;
      for (std::size_t a = 0; a < d; ++a)
        square += std::pow(reference_position.data()[i * d + a] - point[a], 2);
      const double q = std::sqrt(square) / radius;
      share_[i] = q < 1.0 ? std::pow(1.0 - q, 4) * (1.0 + 4.0 * q) : 0.0;
      sum += share_[i];
    }
    if (sum == 0.0) throw CaseError(place + ": no particle lies around the point of the force");
    for (double& share : share_) share /= sum;
  }
  std::array<double, 3> at = point;
  for (std::size_t a = 0; a < d; ++a)
    value_[a] = finite(force.component[a](dimensions(), at.data(), time() + 0.5 * dt()), time() + 0.5 * dt());
}

void TorqueLoad::begin() {
  const auto d = static_cast<std::size_t>(dimensions());
  if (!loaded.looked()) loaded.look(dimensions(), n_particles(), reference_position.data());
  double total = 0, inertia = 0;
  centre_ = {};
  for (const std::uint64_t i : loaded.particles()) {
    total += mass.data()[i];
    for (std::size_t a = 0; a < d; ++a) centre_[a] += mass.data()[i] * position.data()[i * d + a];
  }
  for (double& component : centre_) component /= total;
  for (const std::uint64_t i : loaded.particles()) {
    double square = 0, along = 0;
    for (std::size_t a = 0; a < d; ++a) {
      const double r = position.data()[i * d + a] - centre_[a];
      square += r * r;
      along += r * axis[a];
    }
    inertia += mass.data()[i] * (square - along * along);
  }
  if (!(inertia > 1e-9 * total * spacing() * spacing()))
    throw CaseError(loaded.region.place +
                    ": the particles of the region lie on the axis of the torque, about which they cannot "
                    "turn; choose a region of more particles");
  const double middle = time() + 0.5 * dt();
  angular_acceleration_ = finite(torque(dimensions(), centre_.data(), middle), middle) / inertia;
}

}  // namespace shoal::solid
