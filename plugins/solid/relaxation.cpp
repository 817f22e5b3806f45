// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace shoal::solid {
namespace {

constexpr double largest_square_wanted = 2.0;  // of w; 4 is unstable
constexpr double square_that_warns = 3.2;
constexpr double most_damping = 1.9;     // with 2 nothing is left of the last step
constexpr double largest_stretch = 0.2;  // of a bond in one step
constexpr double turned_bond = 0.05, slightly_turned_bond = 0.002;
constexpr std::uint64_t slow_iterations = 8;

template <class... Arguments>
std::string formatted(const char* format, Arguments... arguments) {
  char text[256];
  std::snprintf(text, sizeof text, format, arguments...);
  return text;
}

}  // namespace

double Rest::relative() const {
  const double acting = std::sqrt(inner) + std::sqrt(outer);
  return acting > 0.0 ? std::sqrt(out_of_balance) / acting : 0.0;
}

void OutOfBalance::end() {
  if (first) rest->out_of_balance = rest->inner = rest->outer = 0.0;
  rest->out_of_balance += out_of_balance.result();
  rest->inner += inner.result();
  rest->outer += outer.result();
}

bool Relaxation::at_rest() const {
  const double relative = rest->relative();
  const bool settled = step().number > 0 && time() + 0.5 * dt() >= rest->from;
  const bool rests = settled && relative <= rest->tolerance;
  if (!first) return rests;
  log_debug(formatted("solid.quasi_static: step %llu, out-of-balance force %.3g",
                      static_cast<unsigned long long>(step().number), relative));
  if (rests)
    finish_run(formatted("at rest: out-of-balance force %.2g of the forces that act, after %llu iterations",
                         relative, static_cast<unsigned long long>(step().number)));
  else if (step().number + 1 >= rest->iterations)
    throw PhysicsFailed(formatted(
        "no rest after %llu iterations: out-of-balance force %.2g of the forces that act, wanted %.2g; "
        "allow more iterations, let the loads grow with t, or look whether the body is held and stable",
        static_cast<unsigned long long>(step().number + 1), relative, rest->tolerance));
  return rests;
}

void Relaxation::begin() {
  const std::size_t n = n_particles() * static_cast<std::size_t>(dimensions());
  if (at_rest()) {
    std::fill_n(velocity.data(), n, 0.0);
    return;
  }
  look_at_mass();
  std::vector<double> now(n);
  const auto d = static_cast<std::size_t>(dimensions());
  for (std::size_t k = 0; k < n; ++k)
    now[k] = (held.data()[k / d] >> (k % d) & 1) != 0
                 ? 0.0
                 : mass.data()[k / d] * (internal.data()[k] + acceleration.data()[k]);
  const double c = damping(now);

  move(now, c);
}

void Relaxation::assemble() {
  mass_.assemble(at.data(), {structure->weights, n_particles(), structure->stiffness_on_grid(), spacing(),
                             volume.data(), F_at.data(), held.data()});
}

void Relaxation::look_at_mass() {
  const auto d = static_cast<std::size_t>(dimensions());
  const std::size_t n = n_particles() * d;
  const auto remember = [&] {
    std::copy_n(position.data(), n, at.data());
    std::copy_n(F.data(), n * d, F_at.data());
    assemble();
  };
  if (!mass_.assembled()) {
    build_weights();
    mass_.kind = kind;
    mass_.connect(dimensions(), neighbours(0), reference_position.data(), spacing(),
                  structure->constants.shear_modulus);
    if (state_.started == 0) {
      std::fill_n(momentum.data(), n, 0.0);
      std::fill_n(velocity.data(), n, 0.0);
      remember();
      state_ = {1, step().number, largest_square() / largest_square_wanted};
      return;
    }
    assemble();  // gone on from a checkpoint
  }
  const double changed = mass_.changed(position.data());
  const bool slow = step().number >= state_.assembled_at + slow_iterations && changed > slightly_turned_bond;
  if (changed < turned_bond && !slow) return;
  remember();
  state_.assembled_at = step().number;
  // The motion goes on as it was, with the momentum that belongs to it now.
  step_.resize(n);
  for (std::size_t k = 0; k < n; ++k) step_[k] = velocity.data()[k] * dt();
  mass_.multiply(step_.data(), momentum.data());
  for (std::size_t k = 0; k < n; ++k) momentum.data()[k] *= state_.theta;
}

// Largest eigenvalue of M^-1 K, K of the undeformed body as linear elasticity, with theta = 1.
double Relaxation::largest_square() const {
  constexpr int iterations = 40;
  build_weights();
  const ReferenceWeights& weights = structure->weights;
  const auto d = static_cast<std::size_t>(dimensions());
  const std::size_t n = n_particles() * d;
  AlignedNumbers u, f;
  weights.random_start(u);
  f.assign(n);
  LinearSpace space;
  double square = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (std::size_t k = 0; k < n; ++k)
      if ((held.data()[k / d] >> (k % d) & 1) != 0) u.data()[k] = 0.0;
    weights.linear_force(structure->stiffness_on_grid(), u.data(), f.data(), space);
    double before = 0, after = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const bool fixed = (held.data()[k / d] >> (k % d) & 1) != 0;
      f.data()[k] = fixed ? 0.0 : -volume.data()[k / d] * f.data()[k];
      before += u.data()[k] * u.data()[k];
    }
    mass_.solve(f.data(), u.data());
    for (std::size_t k = 0; k < n; ++k) after += u.data()[k] * u.data()[k];
    const double last = std::exchange(square, std::sqrt(after / before));
    if (iteration > 4 && std::fabs(square - last) < 1e-3 * square) break;
    const double scale = 1.0 / std::sqrt(after);
    for (std::size_t k = 0; k < n; ++k) u.data()[k] *= scale;
  }
  log_debug(formatted("solid.quasi_static: largest stiffness over that of the mass matrix %.3g", square));
  return square;
}

// w^2 of the motion of the last step, and from it the damping.
double Relaxation::damping(const std::vector<double>& now) {
  const std::size_t n = now.size();
  double met = 0, kinetic = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double u = velocity.data()[k] * dt();
    met += u * (force.data()[k] - now[k]);
    kinetic += u * momentum.data()[k];
  }
  if (!(kinetic > 0.0)) return 0.0;
  double square = met / kinetic;
  if (square > square_that_warns) {
    const double ratio = square / largest_square_wanted;
    state_.theta *= ratio;
    square = largest_square_wanted;
    for (std::size_t k = 0; k < n; ++k) momentum.data()[k] *= ratio;
  }
  return std::min(most_damping, 2.0 * std::sqrt(std::max(square, 0.0)));
}

void Relaxation::move(const std::vector<double>& now, double c) {
  const std::size_t n = now.size();
  double* p = momentum.data();
  for (std::size_t k = 0; k < n; ++k) p[k] = ((2.0 - c) * p[k] + 2.0 * now[k]) / (2.0 + c);
  step_.resize(n);
  mass_.solve(p, step_.data());
  for (double& u : step_) u /= state_.theta;
  const double stretch = mass_.stretch(step_.data());
  const double less = stretch > largest_stretch ? largest_stretch / stretch : 1.0;
  const auto d = static_cast<std::size_t>(dimensions());
  for (std::size_t k = 0; k < n; ++k) {
    force.data()[k] = now[k];
    if ((held.data()[k / d] >> (k % d) & 1) != 0) continue;
    p[k] *= less;
    position.data()[k] += less * step_[k];
    velocity.data()[k] = less * step_[k] / dt();
  }
}

void Relaxation::save(const shoal_stream& stream) const {
  check_host(stream.write(stream.context, &state_, sizeof state_));
}
void Relaxation::load(const shoal_stream& stream) {
  check_host(stream.read(stream.context, &state_, sizeof state_));
}

}  // namespace shoal::solid
