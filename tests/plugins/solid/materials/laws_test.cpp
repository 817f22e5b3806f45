// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What must hold of every stress law: stress is the derivative of energy, frame indifference, symmetry of isotropic
// laws, elastic constants and wave speeds, the volumetric part, and that a particle does not depend on its company.
#include "laws.hpp"

using namespace material_test;

namespace {

double typical_modulus(const Law& law) {
  const shoal_elastic_constants c = law.constants();
  return c.bulk_modulus + 4.0 / 3.0 * c.shear_modulus;
}

}  // namespace

TEST_CASE("stress is the derivative of energy, in space, plane strain and plane stress") {
  for (const Named& each : all_laws()) {
    if (!each.elastic) continue;
    for (const std::uint32_t kinematics : all_kinematics) {
      CAPTURE(each.name);
      CAPTURE(kinematics);
      constexpr std::size_t n = 21;
      const Law law = each.make(kinematics, n);
      const auto F = random_deformations(n, 0.25, law.dimensions(), 7);
      const auto result = law(F);
      const double modulus = typical_modulus(law), h = 1e-5;
      for (int r = 0; r < law.dimensions(); ++r)
        for (int c = 0; c < law.dimensions(); ++c) {
          auto more = F, less = F;
          for (auto& f : more) f(r, c) += h;
          for (auto& f : less) f(r, c) -= h;
          const auto up = law(more), down = law(less);
          for (std::size_t i = 0; i < n; ++i) {
            const double difference = (up.W[i] - down.W[i]) / (2.0 * h);
            CHECK(std::abs(result.P[i](r, c) - difference) < 2e-7 * modulus);
          }
        }
      for (std::size_t i = 0; i < n; ++i) {
        CHECK(result.W[i] > 0.0);
        if (kinematics == SHOAL_PLANE_STRESS) CHECK(std::abs(result.P[i](2, 2)) < 2e-13 * modulus);
      }
    }
  }
}

TEST_CASE("plane strain is space with F33 = 1, plane stress is space with the F33 that it says") {
  for (const Named& each : all_laws())
    for (const std::uint32_t kinematics : {SHOAL_PLANE_STRAIN, SHOAL_PLANE_STRESS}) {
      CAPTURE(each.name);
      constexpr std::size_t n = 13;
      const Law plane = each.make(kinematics, n), space = each.make(SHOAL_THREE_DIMENSIONAL, n);
      auto F = random_deformations(n, 0.2, 2, 11);
      const auto in_plane = plane(F, false, 1e-3);
      for (std::size_t i = 0; i < n; ++i) {
        if (kinematics == SHOAL_PLANE_STRAIN) CHECK(in_plane.F33[i] == 1.0);
        F[i](2, 2) = in_plane.F33[i];
      }
      const auto in_space = space(F, false, 1e-3);
      for (std::size_t i = 0; i < n; ++i) {
        CHECK((in_plane.P[i] - in_space.P[i]).norm() < 1e-12 * typical_modulus(space));
        CHECK(in_plane.W[i] == doctest::Approx(in_space.W[i]).epsilon(1e-11));
      }
    }
}

TEST_CASE("a rotation of the deformed body rotates the stress, and stores no energy") {
  for (const Named& each : all_laws())
    for (const std::uint32_t kinematics : all_kinematics) {
      CAPTURE(each.name);
      CAPTURE(kinematics);
      constexpr std::size_t n = 17;
      const Law law = each.make(kinematics, n);
      const Matrix Q = random_rotation(law.dimensions(), 3);
      const auto F = random_deformations(n, 0.25, law.dimensions(), 5);
      auto turned = F;
      for (auto& f : turned) f = Q * f;
      const auto before = law(F, false, 1e-3), after = law(turned, false, 1e-3);
      for (std::size_t i = 0; i < n; ++i) {
        CHECK((after.P[i] - Q * before.P[i]).norm() < 1e-11 * typical_modulus(law));
        CHECK(std::abs(after.W[i] - before.W[i]) < 1e-12 * typical_modulus(law));
      }
      const auto rigid = law(std::vector<Matrix>(n, Q), false, 1e-3);
      CHECK(rigid.P[0].norm() < 1e-14 * typical_modulus(law));
      CHECK(std::abs(rigid.W[0]) < 1e-14 * typical_modulus(law));
    }
}

TEST_CASE("isotropic laws do not know which way the body was turned before") {
  for (const Named& each : all_laws()) {
    if (!each.isotropic) continue;
    for (const std::uint32_t kinematics : all_kinematics) {
      CAPTURE(each.name);
      constexpr std::size_t n = 9;
      const Law law = each.make(kinematics, n);
      const Matrix Q = random_rotation(law.dimensions(), 4);
      const auto F = random_deformations(n, 0.25, law.dimensions(), 6);
      auto turned = F;
      for (auto& f : turned) f = f * Q;
      const auto before = law(F, false, 1e-3), after = law(turned, false, 1e-3);
      for (std::size_t i = 0; i < n; ++i)
        CHECK((after.P[i] - before.P[i] * Q).norm() < 1e-11 * typical_modulus(law));
    }
  }
}

namespace {

// Largest eigenvalue of the acoustic tensor N_J N_L dP_iJ / dF_kL over many directions N, by differences of stresses.
double stiffest_wave(const Law& law, const Matrix& F) {
  const int d = law.dimensions();
  const double h = 1e-5;
  std::vector<std::vector<Matrix>> derivative(3, std::vector<Matrix>(3, Matrix::Zero()));
  for (int k = 0; k < d; ++k)
    for (int L = 0; L < d; ++L) {
      Matrix more = F, less = F;
      more(k, L) += h;
      less(k, L) -= h;
      derivative[std::size_t(k)][std::size_t(L)] = (law({more}).P[0] - law({less}).P[0]) / (2.0 * h);
    }
  double largest = 0.0;
  for (int p = 0; p < 180; ++p)
    for (int q = 0; q < (d == 2 ? 1 : 90); ++q) {
      const double azimuth = p * M_PI / 180, polar = d == 2 ? M_PI / 2 : (q + 0.5) * M_PI / 90;
      const Vector N(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                     std::cos(polar));
      Eigen::MatrixXd acoustic(d, d);
      for (int i = 0; i < d; ++i)
        for (int k = 0; k < d; ++k) {
          double sum = 0.0;
          for (int L = 0; L < d; ++L)
            sum += derivative[std::size_t(k)][std::size_t(L)].row(i).head(d).dot(N.head(d)) * N(L);
          acoustic(i, k) = sum;
        }
      const Eigen::MatrixXd symmetric = 0.5 * (acoustic + acoustic.transpose());
      largest = std::max(largest,
                         Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues().maxCoeff());
    }
  return largest;
}

}  // namespace

TEST_CASE("elastic constants are those of small strains, wave speeds those of the acoustic tensor at F = I") {
  for (const Named& each : all_laws())
    for (const std::uint32_t kinematics : all_kinematics) {
      CAPTURE(each.name);
      CAPTURE(kinematics);
      const Law law = each.make(kinematics, 1);
      const shoal_elastic_constants c = law.constants();
      const double h = 1e-5, K = c.bulk_modulus, G = c.shear_modulus;
      const bool whole = each.isotropic || each.name == "Guccione";
      if (kinematics == SHOAL_THREE_DIMENSIONAL && whole) {
        const double swell = law({Matrix(Matrix::Identity() * (1.0 + h))}).P[0].trace() / 3.0;
        const double shrink = law({Matrix(Matrix::Identity() * (1.0 - h))}).P[0].trace() / 3.0;
        CHECK((swell - shrink) / (6.0 * h) == doctest::Approx(K).epsilon(1e-4));
      }
      if (each.isotropic) {
        Matrix sheared = Matrix::Identity();
        sheared(0, 1) = h;
        CHECK(law({sheared}).P[0](0, 1) / h == doctest::Approx(G).epsilon(1e-4));
        const double E = 9.0 * K * G / (3.0 * K + G), nu = E / (2.0 * G) - 1.0;
        const double modulus = kinematics == SHOAL_PLANE_STRESS ? E / (1.0 - nu * nu) : K + 4.0 / 3.0 * G;
        CHECK(c.longitudinal_speed == doctest::Approx(std::sqrt(modulus / c.density)).epsilon(1e-5));
        CHECK(c.shear_speed == doctest::Approx(std::sqrt(G / c.density)).epsilon(1e-12));
      }
      const double brute = std::sqrt(stiffest_wave(law, Matrix::Identity()) / c.density);
      // Fibres that only pull have two moduli at rest; a central difference sees their mean.
      CHECK(c.longitudinal_speed == doctest::Approx(brute).epsilon(1e-3));
    }
}

namespace {

bool is_plastic(const Named& law) { return law.name.find("plastic") == 0 || law.name.find("Johnson") == 0; }

}  // namespace

TEST_CASE("wave speeds of deformed bodies are those of the acoustic tensor") {
  for (const Named& each : all_laws())
    for (const std::uint32_t kinematics : all_kinematics) {
      const Law law = each.make(kinematics, 6);
      if (law.law->wave_speed == nullptr || is_plastic(each)) continue;
      CAPTURE(each.name);
      CAPTURE(kinematics);
      const auto F = random_deformations(6, 0.3, law.dimensions(), 12);
      const auto speed = law.wave_speeds(F);
      // That of St. Venant-Kirchhoff is a bound, cheap and close for the small strains that the law is for.
      const bool is_bound =
          each.name.find("Kirchhoff") != std::string::npos && kinematics != SHOAL_PLANE_STRESS;
      for (std::size_t i = 0; i < F.size(); ++i) {
        const double brute = std::sqrt(stiffest_wave(law, F[i]) / law.constants().density);
        CHECK(speed[i] > 0.98 * brute);
        CHECK(speed[i] < (is_bound ? 1.15 : 1.02) * brute);
      }
    }
}

TEST_CASE(
    "plastic laws give a bound of the speed of elastic waves after any plastic flow, at most 8 % above") {
  for (const Named& each : all_laws()) {
    if (!is_plastic(each) || !each.elastic) continue;
    Law law = each.make(SHOAL_THREE_DIMENSIONAL, 1);
    for (const Matrix& F : random_deformations(12, 0.5, 3, 16)) {
      // All of the change of shape is plastic: G = J^(2/3) C^-1.
      const Matrix G = std::pow(F.determinant(), 2.0 / 3.0) * (F.transpose() * F).inverse();
      law.field("plastic_metric") = {G(0, 0), G(0, 1), G(0, 2), G(1, 1), G(1, 2), G(2, 2)};
      const double brute = std::sqrt(stiffest_wave(law, F) / law.constants().density);
      const double bound = law.wave_speeds({F})[0];
      CHECK(bound > 0.999 * brute);
      CHECK(bound < 1.08 * brute);
    }
  }
}

TEST_CASE("the volumetric pressure has the bulk modulus, and is all of the pressure of split laws") {
  for (const Named& each : all_laws()) {
    CAPTURE(each.name);
    constexpr std::size_t n = 11;
    const Law law = each.make(SHOAL_THREE_DIMENSIONAL, n);
    const double K = law.constants().bulk_modulus;
    // Those that do not keep volume and shape apart offer none.
    CHECK((law.law->volumetric_pressure != nullptr) == each.split);
    if (!each.split || law.law->volumetric_pressure == nullptr) continue;
    const std::vector<double> near{1.0 - 1e-5, 1.0, 1.0 + 1e-5};
    std::vector<double> p(3);
    law.law->volumetric_pressure(law.self(), 3, near.data(), p.data());
    CHECK((p[0] - p[2]) / 2e-5 == doctest::Approx(K).epsilon(1e-6));
    CHECK(p[1] == 0.0);
    const auto F = random_deformations(n, 0.25, 3, 13);
    const auto result = law(F, false, 1e-3);
    for (std::size_t i = 0; i < n; ++i) {
      const double J = F[i].determinant();
      law.law->volumetric_pressure(law.self(), 1, &J, p.data());
      CHECK(std::abs((result.P[i] * F[i].transpose()).trace() + 3.0 * p[0] * J) <
            1e-12 * typical_modulus(law));
    }
  }
}

TEST_CASE("a particle's stress and state are the same bits alone and in any company") {
  for (const Named& each : all_laws())
    for (const std::uint32_t kinematics : all_kinematics) {
      CAPTURE(each.name);
      CAPTURE(kinematics);
      constexpr std::size_t n = 19;
      Law together = each.make(kinematics, n);
      const auto F = random_deformations(n, 0.3, together.dimensions(), 14);
      const auto all = together(F, true, 1e-3);
      for (std::size_t i = 0; i < n; ++i) {
        Law alone = each.make(kinematics, 1);
        const auto one = alone({F[i]}, true, 1e-3);
        CHECK(one.P[0] == all.P[i]);
        CHECK(one.W[0] == all.W[i]);
        for (std::size_t k = 0; k < alone.fields().size(); ++k) {
          const std::size_t components = alone.fields()[k].size();
          for (std::size_t c = 0; c < components; ++c)
            CHECK(alone.fields()[k][c] == together.fields()[k][i * components + c]);
        }
      }
    }
}

TEST_CASE("state changes only when the step is made") {
  for (const Named& each : all_laws()) {
    if (each.elastic) continue;
    CAPTURE(each.name);
    Law law = each.make(SHOAL_THREE_DIMENSIONAL, 5);
    const auto before = law.fields();
    const auto F = random_deformations(5, 0.3, 3, 15);
    const auto looked = law(F, false, 1e-3);
    CHECK(law.fields() == before);
    const auto made = law(F, true, 1e-3);
    CHECK(law.fields() != before);
    CHECK(looked.P == made.P);
    CHECK(law.field("equivalent_plastic_strain")[0] > 0.0);
  }
}
