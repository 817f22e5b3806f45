// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// J2 plasticity against a slow integration of the same equations with Eigen, and against the uniaxial curve.
#include "laws.hpp"

using namespace material_test;
using namespace shoal::solid;

namespace {

constexpr double E = 200.0, nu = 0.3, mu = E / (2.0 * (1.0 + nu)), K = E / (3.0 * (1.0 - 2.0 * nu));
constexpr double yield = 0.4, hardening = 0.5, saturated = 0.9, rate = 12.0;
const Values metal{{"density", 7800.0},      {"youngs_modulus", E},    {"poisson_ratio", nu},
                   {"yield_stress", yield},  {"hardening", hardening}, {"saturation_stress", saturated},
                   {"saturation_rate", rate}};
double yield_stress(double alpha) {
  return yield + hardening * alpha + (saturated - yield) * (1.0 - std::exp(-rate * alpha));
}

Matrix deviator(const Matrix& a) { return a - a.trace() / 3.0 * Matrix::Identity(); }

// The same material, integrated with the exponential map: after each small elastic step b keeps its eigenvectors while
// its eigenvalues flow, in substeps, until they lie on the yield surface. Nothing is shared with the law.
struct Reference {
  Matrix metric = Matrix::Identity();
  double alpha = 0.0;

  Matrix step(const Matrix& F) {
    const double J = F.determinant();
    const Eigen::SelfAdjointEigenSolver<Matrix> trial(std::pow(J, -2.0 / 3.0) * F * metric * F.transpose());
    const Matrix V = trial.eigenvectors();
    Vector log_b = trial.eigenvalues().array().log();
    const auto principal_deviator = [&](const Vector& l) {
      const Vector b = l.array().exp();
      return Vector(mu * (b.array() - b.mean()));
    };
    const auto excess = [&](const Vector& s, double a) {
      return s.norm() - std::sqrt(2.0 / 3.0) * yield_stress(a);
    };
    const Vector before = log_b, direction = principal_deviator(log_b).normalized();
    if (excess(principal_deviator(log_b), alpha) > 0.0) {
      double low = 0.0, high = 1.0;  // d gamma by bisection: d ln b = -2 d gamma n
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        const Vector s = principal_deviator(before - 2.0 * middle * direction);
        (s.dot(direction) > 0.0 && excess(s, alpha + std::sqrt(2.0 / 3.0) * middle) > 0.0 ? low : high) =
            middle;
      }
      log_b = before - 2.0 * low * direction;
      alpha += std::sqrt(2.0 / 3.0) * low;
    }
    const Matrix b = V * Vector(log_b.array().exp()).asDiagonal() * V.transpose();
    metric = std::pow(J, 2.0 / 3.0) * F.inverse() * b * F.inverse().transpose();
    const Matrix tau = mu * deviator(b) + K / 2.0 * (J * J - 1.0) * Matrix::Identity();
    return tau * F.inverse().transpose();
  }
};

// A path that turns: stretch, then shear while it is twisted, with a change of volume.
Matrix path(double t) {
  Matrix F = Matrix::Identity();
  F(0, 0) += 0.3 * t;
  F(1, 1) -= 0.15 * t;
  F(0, 1) += 0.6 * t * t;
  F(1, 2) += 0.4 * std::sin(3.0 * t);
  F(2, 2) += 0.002 * t;
  return Eigen::AngleAxisd(2.0 * t, Vector(1, 1, 0).normalized()).toRotationMatrix() * F;
}

struct End {
  Matrix P;
  double alpha, volume;
};
End follow(int steps) {
  Law law = Law::of<Plastic>(metal, SHOAL_THREE_DIMENSIONAL);
  End end{};
  for (int k = 1; k <= steps; ++k) end.P = law({path(double(k) / steps)}, true, 1e-3).P[0];
  end.alpha = law.field("equivalent_plastic_strain")[0];
  const auto& g = law.field("plastic_metric");
  Matrix G;
  G << g[0], g[1], g[2], g[1], g[3], g[4], g[2], g[4], g[5];
  end.volume = G.determinant();
  return end;
}

}  // namespace

TEST_CASE("plastic flow along a turning path converges to a slow integration with the exponential map") {
  Reference reference;
  Matrix P;
  constexpr int fine = 20000;
  for (int k = 1; k <= fine; ++k) P = reference.step(path(double(k) / fine));
  const End coarse = follow(200), finer = follow(800);
  // Step by step the law is the same rule, so that with equal steps nothing but rounding lies between them.
  Reference slow;
  Matrix slow_P;
  for (int k = 1; k <= 200; ++k) slow_P = slow.step(path(k / 200.0));
  CHECK((coarse.P - slow_P).norm() < 1e-9 * slow_P.norm());
  CHECK(coarse.alpha == doctest::Approx(slow.alpha).epsilon(1e-10));
  const double error_coarse = (coarse.P - P).norm() / P.norm(), error_finer = (finer.P - P).norm() / P.norm();
  MESSAGE("relative error of the stress with 200 and 800 steps: " << error_coarse << ", " << error_finer);
  CHECK(reference.alpha > 0.4);
  // First order in the step, as backward Euler is.
  CHECK(error_finer < error_coarse / 3.5);
  CHECK(error_finer < 2e-3);
  CHECK(finer.alpha == doctest::Approx(reference.alpha).epsilon(2e-3));
  // The plastic part keeps the volume, after hundreds of steps.
  CHECK(coarse.volume == doctest::Approx(1.0).epsilon(1e-11));
  CHECK(finer.volume == doctest::Approx(1.0).epsilon(1e-11));
}

TEST_CASE("uniaxial tension follows the yield curve: Kirchhoff stress over logarithmic strain") {
  for (const bool thin : {false, true}) {
    // In space the lateral stretch is found so that the sides are free; in plane stress only one is left to find.
    Law law = Law::of<Plastic>(metal, thin ? SHOAL_PLANE_STRESS : SHOAL_THREE_DIMENSIONAL);
    constexpr int steps = 400;
    double lateral = 1.0, worst = 0.0;
    for (int k = 1; k <= steps; ++k) {
      const double stretch = std::exp(0.2 * k / steps);
      Matrix F = Matrix::Identity();
      F(0, 0) = stretch;
      const auto at = [&](double side) {
        F(1, 1) = side;
        F(2, 2) = thin ? 1.0 : side;
        return law({F}, false, 1e-3);
      };
      double a = lateral, b = lateral * 0.9999, side_a = at(a).P[0](1, 1), side_b = at(b).P[0](1, 1);
      for (int n = 0; n < 40 && std::abs(side_b) > 1e-13 * K; ++n) {
        const double next = b - side_b * (b - a) / (side_b - side_a);
        a = b, side_a = side_b, b = next, side_b = at(b).P[0](1, 1);
      }
      lateral = b;
      at(lateral);
      const auto made = law({F}, true, 1e-3);
      const double tau = made.P[0](0, 0) * stretch, alpha = law.field("equivalent_plastic_strain")[0];
      if (thin) CHECK(made.F33[0] == doctest::Approx(lateral).epsilon(1e-9));
      if (alpha == 0.0) continue;
      CHECK(tau == doctest::Approx(yield_stress(alpha)).epsilon(1e-9));
      // Elastic stretch from the stress: mean tau gives J, and b = diag(x + 2s, x - s, x - s) with det b = 1.
      const double J = std::sqrt(1.0 + 2.0 * tau / 3.0 / K), s = tau / (3.0 * mu);
      double x = 1.0;
      for (int n = 0; n < 50; ++n)
        x -= ((x + 2 * s) * (x - s) * (x - s) - 1.0) / ((x - s) * (x - s) + 2 * (x + 2 * s) * (x - s));
      const double elastic = std::log(std::cbrt(J) * std::sqrt(x + 2.0 * s));
      worst = std::max(worst, std::abs(alpha + elastic - std::log(stretch)) / std::log(stretch));
    }
    MESSAGE("largest relative difference of the strain from the analytic curve: " << worst);
    // The direction of flow is constant here, so that nothing is lost to the size of the steps.
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("unloading is elastic, and yielding begins at the stress where it ended") {
  Law law = Law::of<Plastic>(metal, SHOAL_THREE_DIMENSIONAL);
  const auto shear = [&](double gamma, bool updates) {
    Matrix F = Matrix::Identity();
    F(0, 1) = gamma;
    return law({F}, updates, 1e-3).P[0](0, 1);
  };
  double loaded = 0.0;
  for (int k = 1; k <= 100; ++k) loaded = shear(1e-3 * k, true);
  const double alpha = law.field("equivalent_plastic_strain")[0];
  CHECK(shear(0.1 - 1e-4, true) == doctest::Approx(loaded - mu * 1e-4).epsilon(1e-3));
  CHECK(law.field("equivalent_plastic_strain")[0] == alpha);
  CHECK(shear(0.1, true) == doctest::Approx(loaded).epsilon(1e-6));
  CHECK(shear(0.101, true) - loaded < 0.1 * mu * 1e-3);
  CHECK(law.field("equivalent_plastic_strain")[0] > alpha);
}

TEST_CASE("Johnson-Cook: rate, heating and softening as in the formula") {
  const double A = 0.3, B = 0.6, n = 0.35, C = 0.04, melting = 0.9, capacity = 2e-3, m = 1.2, rho = 7.0,
               dt = 1e-3;
  Law law = Law::of<JohnsonCook>({{"density", rho},
                                  {"youngs_modulus", E},
                                  {"poisson_ratio", nu},
                                  {"a", A},
                                  {"b", B},
                                  {"n", n},
                                  {"c", C},
                                  {"m", m},
                                  {"reference_rate", 0.5},
                                  {"melting_temperature_rise", melting},
                                  {"heat_capacity", capacity}},
                                 SHOAL_THREE_DIMENSIONAL);
  double heating = 0.0;
  for (int k = 1; k <= 150; ++k) {
    Matrix F = Matrix::Identity();
    F(0, 1) = 2e-3 * k;
    const double before = law.field("equivalent_plastic_strain")[0];
    const Matrix P = law({F}, true, dt).P[0];
    const double alpha = law.field("equivalent_plastic_strain")[0];
    if (alpha == before) continue;
    const double softening = 1.0 - std::pow(std::min(1.0, heating / melting), m);
    const double expected = (A + B * std::pow(alpha, n)) *
                            (1.0 + C * std::log(std::max(1.0, (alpha - before) / dt / 0.5))) * softening;
    const Matrix tau = P * F.transpose();
    CHECK(std::sqrt(1.5) * deviator(tau).norm() == doctest::Approx(expected).epsilon(1e-8));
    heating += 0.9 / (rho * capacity) * expected * (alpha - before);
    CHECK(law.field("plastic_heating")[0] == doctest::Approx(heating).epsilon(1e-9));
  }
  CHECK(heating > 0.3 * melting);
}
