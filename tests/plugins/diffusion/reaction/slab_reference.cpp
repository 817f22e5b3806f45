// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The slab of Niederer et al. (2011) by finite differences on its nodes, nothing of which the particles share but the
// cell, whose rates are compared with the printed equations elsewhere. Second differences mirrored at the surfaces, Heun's
// method for them, Strang splitting. Prints the activation times (V = 0) of P1 ... P9 in ms:
//     test_slab_reference 0.25 0.1 0.0125      (spacing along the fibres and across, mm; step, ms)
// cases/reference/diffusion/niederer_finite_differences.csv holds what it gave and the limit.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "cells.hpp"
#include "ten_tusscher_panfilov.hpp"

using namespace shoal;
using namespace shoal::diffusion;

namespace {

constexpr double size_mm[3] = {20.0, 7.0, 3.0}, stimulated_mm = 1.5;
// Conductivity / (membrane per volume * capacitance), mm2/ms, along and across the fibres; stimulus in V/s
constexpr double along = 0.17 * 0.62 / 0.79 / 1.4, across = 0.019 * 0.24 / 0.259 / 1.4, stimulus = 5e4 / 1400;

class Slab {
 public:
  Slab(double dx, double dy, const ReactionIntegrator& reaction) : dx_{dx, dy, dy}, reaction_(reaction) {
    for (std::size_t a = 0; a < 3; ++a)
      n_[a] = static_cast<std::size_t>(std::lround(size_mm[a] / dx_[a])) + 1;
    total_ = n_[0] * n_[1] * n_[2];
    y_.resize(reaction.n_variables());
    for (std::size_t v = 0; v < y_.size(); ++v)
      y_[v].assign(total_ + SHOAL_PADDING, reaction.variable(v).initial);
    position_.resize(3 * total_);
    activation_.assign(total_, -1.0);
    rate_.resize(total_);
    middle_.resize(total_);
    for (std::size_t i = 0; i < n_[0]; ++i)
      for (std::size_t j = 0; j < n_[1]; ++j)
        for (std::size_t k = 0; k < n_[2]; ++k)
          source_.push_back(stimulus * share(0, i) * share(1, j) * share(2, k));
  }

  void start(double half_step) { react(0.0, half_step); }
  // Strang splitting; the reaction's second half and the first of the next step are one.
  void step(double t, double dt) {  // ms
    before_ = y_[0];
    const int parts =
        static_cast<int>(std::ceil(dt * 4.0 * (over_square(0) + over_square(1) + over_square(2)) / 1.6));
    for (int k = 0; k < parts; ++k) diffuse(dt / parts);
    react(t + 0.5 * dt, dt);
    for (std::size_t i = 0; i < total_; ++i)
      if (activation_[i] < 0.0 && y_[0][i] >= 0.0)
        activation_[i] = t + 0.5 * dt + dt * (0.0 - before_[i]) / (y_[0][i] - before_[i]);
  }
  double activation(double x, double y, double z) const {
    const auto node = [&](std::size_t a, double s) {
      return static_cast<std::size_t>(std::lround(s / dx_[a]));
    };
    return activation_[(node(0, x) * n_[1] + node(1, y)) * n_[2] + node(2, z)];
  }

 private:
  double over_square(std::size_t a) const { return (a == 0 ? along : across) / (dx_[a] * dx_[a]); }
  // Of the volume of node i that is stimulated, along axis a.
  double share(std::size_t a, std::size_t i) const {
    const double beyond = static_cast<double>(i) * dx_[a] - stimulated_mm;
    return beyond > 1e-9 ? 0.0 : beyond > -1e-9 ? 0.5 : 1.0;
  }
  template <class Work>
  void in_planes(Work&& work) {
    constexpr std::size_t parts = 2;
    std::vector<std::jthread> threads;
    for (std::size_t p = 0; p < parts; ++p)
      threads.emplace_back([&, p] { work(n_[0] * p / parts, n_[0] * (p + 1) / parts); });
  }
  void react(double t, double dt) {
    const std::size_t plane = n_[1] * n_[2];
    in_planes([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::vector<double*> at;
        for (auto& values : y_) at.push_back(values.data() + i * plane);
        reaction_.advance(3, 1e-3 * t, 1e-3 * dt, plane, position_.data(), at.data(),
                          t < 2.0 - 1e-9 ? source_.data() + i * plane : nullptr);
      }
    });
  }
  void diffuse(double dt) {
    std::vector<double>& v = y_[0];
    differences(v);
    for (std::size_t i = 0; i < total_; ++i) {
      middle_[i] = v[i] + dt * rate_[i];
      v[i] += 0.5 * dt * rate_[i];
    }
    differences(middle_);
    for (std::size_t i = 0; i < total_; ++i) v[i] += 0.5 * dt * rate_[i];
  }
  void differences(const std::vector<double>& v) {
    const std::size_t stride[3] = {n_[1] * n_[2], n_[2], 1};
    const double d[3] = {over_square(0), over_square(1), over_square(2)};
    in_planes([&](std::size_t begin, std::size_t end) {
      std::size_t at[3];
      for (at[0] = begin; at[0] < end; ++at[0])
        for (at[1] = 0; at[1] < n_[1]; ++at[1])
          for (at[2] = 0; at[2] < n_[2]; ++at[2]) {
            const std::size_t i = at[0] * stride[0] + at[1] * stride[1] + at[2];
            double sum = 0;
            for (std::size_t a = 0; a < 3; ++a) {
              const std::size_t low = at[a] == 0 ? i + stride[a] : i - stride[a];
              const std::size_t high = at[a] + 1 == n_[a] ? i - stride[a] : i + stride[a];
              sum += d[a] * (v[low] + v[high] - 2.0 * v[i]);
            }
            rate_[i] = sum;
          }
    });
  }

  std::array<double, 3> dx_;
  const ReactionIntegrator& reaction_;
  std::array<std::size_t, 3> n_{};
  std::size_t total_ = 0;
  std::vector<std::vector<double>> y_;
  std::vector<double> position_, activation_, rate_, middle_, source_, before_;
};

}  // namespace

int main(int argc, char** argv) {
  const double dx = argc > 1 ? std::atof(argv[1]) : 0.2, dy = argc > 2 ? std::atof(argv[2]) : dx,
               dt = argc > 3 ? std::atof(argv[3]) : 0.05;
  const TenTusscherPanfilov model;
  const ReactionIntegrator reaction(test::interface_of(model));
  Slab slab(dx, dy, reaction);
  slab.start(0.5 * dt);
  for (int k = 0; slab.activation(20, 7, 3) < 0.0 && k * dt < 200.0; ++k) slab.step(k * dt, dt);
  const double points[9][3] = {{0, 0, 0}, {0, 7, 0},  {20, 0, 0}, {20, 7, 0},    {0, 0, 3},
                               {0, 7, 3}, {20, 0, 3}, {20, 7, 3}, {10, 3.5, 1.5}};
  std::printf("# %g mm along the fibres, %g mm across, steps of %g ms\n", dx, dy, dt);
  for (int p = 0; p < 9; ++p)
    std::printf("P%d,%.4f\n", p + 1, slab.activation(points[p][0], points[p][1], points[p][2]));
}
