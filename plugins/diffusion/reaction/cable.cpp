// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "cable.hpp"

#include <algorithm>
#include <cmath>

namespace shoal::diffusion {
namespace {

class Wave {
 public:
  Wave(const ReactionIntegrator& reaction, const Cable& cable)
      : reaction_(reaction), cable_(cable), y_(reaction.n_variables()), position_(cable.nodes) {
    const std::size_t room = (cable.nodes + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
    for (std::size_t v = 0; v < y_.size(); ++v) y_[v].assign(room, reaction.variable(v).initial);
    std::fill_n(y_[0].begin(), cable.nodes / 6, reaction.variable(0).excited);
    for (auto& values : y_) pointers_.push_back(values.data());
    for (auto* scratch : {&rate_, &middle_}) scratch->resize(cable.nodes);
    double largest = 0;
    for (const double l : cable.weights) largest += 4.0 * std::abs(l);
    // Heun's method is stable for dt lambda <= 2.
    substeps_ = std::max(1, static_cast<int>(std::ceil(cable.step * largest / 1.5)));
  }

  double potential(std::size_t i) const { return y_[0][i]; }
  void advance() {
    react();
    for (int k = 0; k < substeps_; ++k) diffuse(cable_.step / substeps_);
    react();
  }

 private:
  void react() {
    reaction_.advance(1, 0.0, 0.5 * cable_.step, cable_.nodes, position_.data(), pointers_.data(), nullptr);
  }
  void diffuse(double dt) {
    double* y = y_[0].data();
    differences(y);
    for (std::size_t i = 0; i < cable_.nodes; ++i) {
      middle_[i] = y[i] + dt * rate_[i];
      y[i] += 0.5 * dt * rate_[i];
    }
    differences(middle_.data());
    for (std::size_t i = 0; i < cable_.nodes; ++i) y[i] += 0.5 * dt * rate_[i];
  }
  // Mirrored at both ends.
  void differences(const double* y) {
    const auto n = static_cast<std::ptrdiff_t>(cable_.nodes);
    const auto at = [&](std::ptrdiff_t i) { return y[i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i]; };
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < cable_.weights.size(); ++k) {
        const auto far = static_cast<std::ptrdiff_t>(k) + 1;
        sum += cable_.weights[k] * (at(i + far) + at(i - far) - 2.0 * y[i]);
      }
      rate_[static_cast<std::size_t>(i)] = sum;
    }
  }

  const ReactionIntegrator& reaction_;
  const Cable& cable_;
  std::vector<std::vector<double>> y_;
  std::vector<double*> pointers_;
  std::vector<double> position_, rate_, middle_;
  int substeps_ = 1;
};

}  // namespace

double wave_speed(const ReactionIntegrator& reaction, const Cable& cable) {
  Wave wave(reaction, cable);
  const shoal_reaction_variable& first = reaction.variable(0);
  const double threshold = 0.5 * (first.initial + first.excited);
  const std::size_t gates[2] = {cable.nodes * 55 / 100, cable.nodes * 9 / 10};
  double passed[2] = {-1.0, -1.0}, before[2] = {wave.potential(gates[0]), wave.potential(gates[1])};
  for (std::uint64_t k = 0; passed[1] < 0.0; ++k) {
    const double t = static_cast<double>(k) * cable.step;
    if (t > cable.longest_time) return 0.0;
    wave.advance();
    for (int g = 0; g < 2; ++g) {
      const double now = wave.potential(gates[g]);
      if (passed[g] < 0.0 && (now >= threshold) != (before[g] >= threshold))
        passed[g] = t + cable.step * (threshold - before[g]) / (now - before[g]);
      before[g] = now;
    }
  }
  if (!(passed[1] > passed[0]) || passed[0] < 0.0) return 0.0;
  return static_cast<double>(gates[1] - gates[0]) * cable.spacing / (passed[1] - passed[0]);
}

std::vector<double> second_difference(double diffusivity, double spacing) {
  return {diffusivity / (spacing * spacing)};
}

}  // namespace shoal::diffusion
