// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/scene.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace shoal::bench {

Scene::Scene() {
  constants_ = {1000.0 * dx * dx * dx, 1000.0, 20.0};
  place_particles();
  rebuild();
  fill_fields();
}

double* Scene::field(const std::string& name, std::size_t components) {
  auto& buffer = fields_[name];
  if (buffer.data() == nullptr) {
    buffer.reserve(n_ * components + SHOAL_PADDING);
    std::fill_n(buffer.data(), buffer.capacity(), 0.0);
  }
  return buffer.data();
}

void Scene::place_particles() {
  constexpr int sides[] = {58, 58, 60};
  n_ = 58 * 58 * 60;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  std::vector<double> points;
  for (int a = 0; a < sides[0]; ++a)
    for (int b = 0; b < sides[1]; ++b)
      for (int c = 0; c < sides[2]; ++c)
        for (const int k : {a, b, c}) points.push_back(dx * (k + 0.5 + jitter(random)));
  // In memory as a run keeps them: sorted along cells.
  grid_.build({points.data(), n_, 3}, cutoff);
  double* x = field("position", 3);
  for (std::uint64_t k = 0; k < n_; ++k) std::copy_n(points.data() + 3 * grid_.order()[k], 3, x + 3 * k);
}

void Scene::rebuild() {
  const kernel::Positions positions{field("position", 3), n_, 3};
  grid_.build(positions, cutoff);
  list_.build(grid_, positions, cutoff, true);
}

// A vortex, and the pressure of water at rest.
void Scene::fill_fields() {
  const double *x = field("position", 3), c = constants_.sound_speed;
  double *v = field("velocity", 3), *rho = field("density", 1), *p = field("pressure", 1);
  double *volume = field("volume", 1), *mass = field("mass", 1), *g = field("acceleration", 3);
  for (std::uint64_t i = 0; i < n_; ++i) {
    v[3 * i] = std::sin(9.0 * x[3 * i + 1]);
    v[3 * i + 1] = -std::sin(7.0 * x[3 * i]);
    v[3 * i + 2] = 0.3 * std::cos(5.0 * x[3 * i + 2]);
    p[i] = 9810.0 * (0.6 - x[3 * i + 2]);
    rho[i] = constants_.reference_density + p[i] / (c * c);
    mass[i] = constants_.mass;
    volume[i] = mass[i] / rho[i];
    g[3 * i + 2] = -9.81;
  }
}

void Scene::clear_results() {
  for (const char* name : {"pressure_acceleration", "density_rate"})
    if (const auto found = fields_.find(name); found != fields_.end())
      std::fill_n(found->second.data(), found->second.capacity(), 0.0);
}

Target Scene::target() const {
  Target target;
  target.neighbours = {{0}};
  target.smoothing_length = smoothing_length;
  target.cutoff = cutoff;
  target.spacing = dx;
  return target;
}

}  // namespace shoal::bench
