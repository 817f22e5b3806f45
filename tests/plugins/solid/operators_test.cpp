// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators of the solid plugin: the force is the gradient of the energy, and conserves what it must.
#include <doctest/doctest.h>

#include <algorithm>

#include "deformation.hpp"
#include "momentum.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::solid;
using solid_test::dx;

namespace {

constexpr double mu = 3e5, lambda = 8e5, rho = 1200.0;

// Neo-Hookean: W and P.
template <int D>
double energy(const Mat<D>& F) {
  const double log_J = std::log(determinant(F));
  return 0.5 * mu * (double_dot(F, F) - D) - mu * log_J + 0.5 * lambda * log_J * log_J;
}
template <int D>
Mat<D> stress(const Mat<D>& F) {
  const Mat<D> T = transpose(inverse(F));
  return mu * (F - T) + lambda * std::log(determinant(F)) * T;
}

SharedStructure structure() {
  auto made = std::make_shared<Structure>();
  made->settings = solid_test::settings();
  made->constants.density = rho;
  made->hourglass = 0.7 * mu;
  return made;
}

testing::Setup setup() {
  return {.smoothing_length = solid_test::settings().smoothing_length, .spacing = dx};
}

// Moves the particles by a smooth field and noise.
template <int D>
void deform(testing::Body& body) {
  body.set_each("position", D, [&](std::size_t i, std::size_t a) {
    const double X = body["reference_position"][i * D + a],
                 Y = body["reference_position"][i * D + (a + 1) % D];
    return 1.1 * X + 0.2 * Y * Y + 0.02 * dx * std::sin(37.0 * static_cast<double>(i * D + a));
  });
}

template <int D>
double total_energy(testing::Body& body, const SharedStructure& shared) {
  DeformationGradient op;
  op.structure = shared;
  testing::run(op, body, {&body}, setup());
  double sum = 0;
  const double stiffness = shared->hourglass / (dx * dx);
  for (std::size_t i = 0; i < body.size(); ++i) {
    Mat<D> F;
    std::copy_n(body["deformation_gradient"].data() + i * D * D, D * D, F.e);
    sum += body["volume"][i] * energy(F);
    for (std::size_t a = 0; a < D; ++a)
      sum += body["volume"][i] * 0.5 * std::pow(body["hourglass_stress"][i * D + a], 2) / stiffness;
  }
  return sum;
}

template <int D>
void accelerate(testing::Body& body, const SharedStructure& shared) {
  total_energy<D>(body, shared);
  body.set_each("piola_stress", D * D, [&](std::size_t i, std::size_t k) {
    Mat<D> F;
    std::copy_n(body["deformation_gradient"].data() + i * D * D, D * D, F.e);
    return stress(F)[static_cast<int>(k)];
  });
  InternalForce op;
  op.structure = shared;
  testing::run(op, body, {&body}, setup());
}

template <int D>
void compare_with_energy() {
  testing::Body body = solid_test::box(D, D == 2 ? 7 : 6, 0.2);
  // Unequal volumes must not matter.
  body.set_each("volume", 1, [&](std::size_t i, std::size_t) {
    return std::pow(dx, D) * (1.0 + 0.2 * std::sin(static_cast<double>(i)));
  });
  deform<D>(body);
  const SharedStructure shared = structure();
  accelerate<D>(body, shared);
  const std::vector<double> acceleration = body["internal_acceleration"];
  double scale = 0;
  for (const double a : acceleration) scale = std::max(scale, std::fabs(a));
  const double step = 1e-6 * dx;
  for (std::size_t k = 0; k < body.size() * D; k += 7) {
    double& x = body["position"][k];
    const double before = x;
    x = before + step;
    const double more = total_energy<D>(body, shared);
    x = before - step;
    const double less = total_energy<D>(body, shared);
    x = before;
    const double expected = -(more - less) / (2.0 * step) / (rho * body["volume"][k / D]);
    CHECK(std::fabs(acceleration[k] - expected) < 1e-6 * scale);
  }
}

}  // namespace

TEST_CASE("the internal force is minus the gradient of the discrete energy") {
  compare_with_energy<2>();
  compare_with_energy<3>();
}

TEST_CASE("the internal force conserves momentum and angular momentum") {
  testing::Body body = solid_test::box(3, 7, 0.2);
  deform<3>(body);
  accelerate<3>(body, structure());
  Vec<3> force{}, torque{};
  double scale = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    Vec<3> x, a;
    std::copy_n(body["position"].data() + 3 * i, 3, x.e);
    std::copy_n(body["internal_acceleration"].data() + 3 * i, 3, a.e);
    force += a;
    torque += cross(x, a);
    scale += norm(a);
  }
  CHECK(norm(force) < 1e-13 * scale);
  CHECK(norm(torque) < 1e-13 * scale);
}

TEST_CASE("a rotated body has no force") {
  testing::Body body = solid_test::box(2, 8, 0.1);
  const double c = std::cos(1.0), s = std::sin(1.0);
  body.set_each("position", 2, [&](std::size_t i, std::size_t a) {
    const double X = body["reference_position"][2 * i], Y = body["reference_position"][2 * i + 1];
    return a == 0 ? c * X - s * Y + 3.0 : s * X + c * Y - 1.0;
  });
  accelerate<2>(body, structure());
  // In units of modulus over density and spacing.
  for (const double a : body["internal_acceleration"]) CHECK(std::fabs(a) < 1e-11 * mu / (rho * dx));
}
