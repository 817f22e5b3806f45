// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The energy of each law against the formula of its paper, written out from principal stretches or from components
// along the material's axes with Eigen; and what a user reads when values do not fit together.
#include "laws.hpp"

using namespace material_test;
using namespace shoal::solid;

namespace {

const std::vector<Matrix>& deformations() {
  static const std::vector<Matrix> list = random_deformations(23, 0.35, 3, 21);
  return list;
}

// Compares with a function of F.
template <class Energy>
void check_energy(const Law& law, Energy&& energy) {
  const auto result = law(deformations());
  for (std::size_t i = 0; i < deformations().size(); ++i)
    CHECK(result.W[i] == doctest::Approx(energy(deformations()[i])).epsilon(1e-11));
}
Vector principal_stretches(const Matrix& F) { return F.jacobiSvd().singularValues(); }
double split_volume(double K, double J) { return K / 4.0 * (J * J - 1.0 - 2.0 * std::log(J)); }

const Vector fibre(c30, s30, 0.0), sheet(-s30, c30, 0.0), across(0.0, 0.0, 1.0);
constexpr double E = 7.0, nu = 0.35, mu = E / (2.0 * (1.0 + nu)), K = E / (3.0 * (1.0 - 2.0 * nu)),
                 lambda = K - 2.0 / 3.0 * mu;
const Values isotropic{{"density", 1200.0}, {"youngs_modulus", E}, {"poisson_ratio", nu}};

template <class M>
Law space(const Values& values) {
  return Law::of<M>(values, SHOAL_THREE_DIMENSIONAL, deformations().size());
}

}  // namespace

TEST_CASE("energies of isotropic laws follow from the principal stretches") {
  check_energy(space<StVenantKirchhoff>(isotropic), [](const Matrix& F) {
    const Vector l = principal_stretches(F);
    const Vector e = (l.cwiseProduct(l) - Vector::Ones()) / 2.0;
    return lambda / 2.0 * e.sum() * e.sum() + mu * e.squaredNorm();
  });
  check_energy(space<NeoHookean>(isotropic), [](const Matrix& F) {
    const Vector l = principal_stretches(F) / std::cbrt(F.determinant());
    return mu / 2.0 * (l.squaredNorm() - 3.0) + split_volume(K, F.determinant());
  });
  check_energy(space<NeoHookean>(with(isotropic, "form", "coupled")), [](const Matrix& F) {
    const Vector l = principal_stretches(F);
    const double ln_J = std::log(l.prod());
    return mu / 2.0 * (l.squaredNorm() - 3.0) - mu * ln_J + lambda / 2.0 * ln_J * ln_J;
  });
  check_energy(space<MooneyRivlin>({{"density", 1.0}, {"c1", 0.8}, {"c2", 0.3}, {"bulk_modulus", 9.0}}),
               [](const Matrix& F) {
                 const Vector l = principal_stretches(F) / std::cbrt(F.determinant());
                 return 0.8 * (l.squaredNorm() - 3.0) + 0.3 * (l.cwiseInverse().squaredNorm() - 3.0) +
                        split_volume(9.0, F.determinant());
               });
  check_energy(space<Plastic>(with(isotropic, "yield_stress", 1e9)), [](const Matrix& F) {
    const Vector l = principal_stretches(F) / std::cbrt(F.determinant());
    return mu / 2.0 * (l.squaredNorm() - 3.0) + split_volume(K, F.determinant());
  });
}

TEST_CASE("energies of anisotropic laws follow from the strains along their axes") {
  const auto green = [](const Matrix& C) { return Matrix((C - Matrix::Identity()) / 2.0); };
  check_energy(space<Orthotropic>({{"density", 700.0},
                                   {"youngs_moduli", {12.0, 3.0, 5.0}},
                                   {"poisson_ratios", {0.4, 0.2, 0.3}},
                                   {"shear_moduli", {2.0, 1.0, 1.5}},
                                   {"fibre", {c30, s30, 0.0}},
                                   {"sheet", {-s30, c30, 0.0}}}),
               [&](const Matrix& F) {
                 Matrix axes;
                 axes << fibre, sheet, across;
                 const Matrix e = axes.transpose() * green(F.transpose() * F) * axes;
                 Matrix compliance;
                 compliance << 1 / 12.0, -0.4 / 12.0, -0.3 / 12.0, -0.4 / 12.0, 1 / 3.0, -0.2 / 3.0,
                     -0.3 / 12.0, -0.2 / 3.0, 1 / 5.0;
                 const Vector normal = e.diagonal();
                 return 0.5 * normal.dot(compliance.inverse() * normal) +
                        2.0 * (2.0 * e(0, 1) * e(0, 1) + 1.0 * e(1, 2) * e(1, 2) + 1.5 * e(0, 2) * e(0, 2));
               });
  check_energy(space<Guccione>({{"density", 1060.0},
                                {"c", 2.0},
                                {"b_f", 3.0},
                                {"b_t", 0.8},
                                {"b_fs", 1.4},
                                {"bulk_modulus", 12.0},
                                {"fibre", {c30, s30, 0.0}}}),
               [&](const Matrix& F) {
                 const double J = F.determinant();
                 Matrix axes;
                 axes << fibre, sheet, across;
                 const Matrix e =
                     axes.transpose() * green(std::pow(J, -2.0 / 3.0) * F.transpose() * F) * axes;
                 const double Q = 3.0 * e(0, 0) * e(0, 0) +
                                  0.8 * (e(1, 1) * e(1, 1) + e(2, 2) * e(2, 2) + 2.0 * e(1, 2) * e(1, 2)) +
                                  2.0 * 1.4 * (e(0, 1) * e(0, 1) + e(0, 2) * e(0, 2));
                 return 1.0 * (std::exp(Q) - 1.0) + split_volume(12.0, J);
               });
  for (const bool push : {false, true})
    check_energy(space<HolzapfelOgden>(with(holzapfel_ogden, "fibres_push", push ? 1.0 : 0.0)),
                 [&](const Matrix& F) {
                   const Matrix C = F.transpose() * F;
                   const double ln_J = std::log(F.determinant()), I1 = C.trace(), I_fs = fibre.dot(C * sheet);
                   double e_f = fibre.dot(C * fibre) - 1.0, e_s = sheet.dot(C * sheet) - 1.0;
                   if (!push) e_f = std::max(0.0, e_f), e_s = std::max(0.0, e_s);
                   const double first_lame = 30.0 - 2.0 * 0.59 * 2.0 - 2.0 / 3.0 * 0.59;
                   return 0.59 / 4.0 * (std::exp(2.0 * (I1 - 3.0)) - 1.0) - 0.59 * ln_J +
                          first_lame / 2.0 * ln_J * ln_J + 1.8 / 3.2 * (std::exp(1.6 * e_f * e_f) - 1.0) +
                          0.7 / 2.2 * (std::exp(1.1 * e_s * e_s) - 1.0) +
                          0.4 / 3.0 * (std::exp(1.5 * I_fs * I_fs) - 1.0);
                 });
}

TEST_CASE(
    "directions come from the parameter, or else from the field; they are made or must be unit vectors") {
  Values values = holzapfel_ogden;
  values.insert_or_assign("fibre", Given{3.0 * c30, 3.0 * s30, 0.0});
  Law law = space<HolzapfelOgden>(values);
  CHECK(law.field("fibre")[0] == doctest::Approx(c30));
  const auto from_parameter = law(deformations());

  values.erase("fibre");
  values.erase("sheet");
  Law bare = Law::of<HolzapfelOgden>({{"density", 1.0}, {"bulk_modulus", 30.0}, {"a", 1.0}, {"b", 1.0}},
                                     SHOAL_THREE_DIMENSIONAL);
  CHECK(bare.fields().empty());
  void* self = nullptr;
  const auto* api = static_cast<const shoal_material_api*>(HolzapfelOgden::api<HolzapfelOgden>());
  REQUIRE(Law::create(*api, HolzapfelOgden().parameter_table(), values, 3, &self) == SHOAL_OK);
  const auto* functions = static_cast<const shoal_stress_law*>(api->interface(self, SHOAL_STRESS_LAW, 1));
  const double position[3] = {0, 0, 0};
  std::vector<double> f{0, 0, 0}, s{-s30, c30, 0};
  for (auto* field : {&f, &s}) field->reserve(3 + SHOAL_PADDING);
  double* fields[] = {f.data(), s.data()};
  std::uint32_t n = 0;
  const shoal_access* list = functions->fields(self, SHOAL_THREE_DIMENSIONAL, &n);
  REQUIRE(n == 2);
  CHECK(list[0].mode == SHOAL_READ);
  CHECK(functions->initialise(self, SHOAL_THREE_DIMENSIONAL, 1, position, fields) == SHOAL_CASE_ERROR);
  CHECK(failure ==
        "the material needs the direction 'fibre' at every particle, of length 1; give it in the material "
        "(fibre: "
        "[1, 0, 0]) or as an initial field of the body");
  f = {1, 0, 0};
  CHECK(functions->initialise(self, SHOAL_THREE_DIMENSIONAL, 1, position, fields) == SHOAL_CASE_ERROR);
  CHECK(failure ==
        "the material's directions 'fibre' and 'sheet' must be at right angles to each other at every "
        "particle");
  f = {c30, s30, 0};
  CHECK(functions->initialise(self, SHOAL_THREE_DIMENSIONAL, 1, position, fields) == SHOAL_OK);
  double F[9], P[9];
  for (int k = 0; k < 9; ++k) F[k] = deformations()[0](k / 3, k % 3);
  shoal_stress_block block{};
  block.size = sizeof block;
  block.n = 1;
  block.deformation_gradient = F;
  block.fields = fields;
  block.stress = P;
  REQUIRE(functions->stress(self, &block) == SHOAL_OK);
  CHECK(P[1] == doctest::Approx(from_parameter.P[0](0, 1)).epsilon(1e-12));
  api->destroy(self);
}

namespace {

template <class M>
std::string refusal(const Values& values) {
  void* self = nullptr;
  const auto* api = static_cast<const shoal_material_api*>(M::template api<M>());
  CHECK(Law::create(*api, M().parameter_table(), values, 3, &self) == SHOAL_CASE_ERROR);
  return failure;
}

}  // namespace

TEST_CASE("values that do not fit together are refused with the place and the remedy") {
  CHECK(refusal<MooneyRivlin>({{"density", 1.0}, {"c1", 0.0}, {"c2", 0.0}, {"bulk_modulus", 1.0}}) ==
        "case.yaml:1:1: c1 and c2 are both zero, so nothing resists a change of shape");
  CHECK(refusal<HolzapfelOgden>({{"density", 1.0}, {"bulk_modulus", 3.0}, {"a", 1.0}, {"b", 2.0}}) ==
        "case.yaml:1:1: bulk_modulus must be larger than 2 a b, which the ground substance adds");
  const Values metal = with(isotropic, "yield_stress", 1.0);
  CHECK(refusal<Plastic>(with(metal, "saturation_stress", 2.0)) ==
        "case.yaml:1:1: saturation_stress and saturation_rate belong together");
  CHECK(refusal<Plastic>(with(with(metal, "saturation_stress", 0.5), "saturation_rate", 2.0)) ==
        "case.yaml:1:1: saturation_stress is less than yield_stress");
  CHECK(refusal<JohnsonCook>(
            with(with(with(with(isotropic, "a", 1.0), "b", 1.0), "n", 1.0), "heat_capacity", 1.0)) ==
        "case.yaml:1:1: melting_temperature_rise and heat_capacity belong together");
  Values wood{{"density", 700.0},
              {"youngs_moduli", {12.0, 3.0}},
              {"poisson_ratios", {0.4, 0.2, 0.3}},
              {"shear_moduli", {2.0, 1.0, 1.5}},
              {"fibre", {1.0, 0.0, 0.0}},
              {"sheet", {0.0, 1.0, 0.0}}};
  CHECK(refusal<Orthotropic>(wood) == "case.yaml:1:1: expected three numbers, e.g. [12e9, 0.9e9, 0.5e9]");
  wood.insert_or_assign("youngs_moduli", Given{12.0, 3.0, 5.0});
  wood.insert_or_assign("poisson_ratios", Given{2.5, 0.2, 0.3});
  CHECK(refusal<Orthotropic>(wood) ==
        "case.yaml:1:1: with these Poisson's ratios the material would gain energy when deformed; they must "
        "satisfy "
        "nu12^2 < E1/E2, nu23^2 < E2/E3, nu13^2 < E1/E3 and be small enough together");
}

TEST_CASE("plane stress of a body that is turned inside out fails with a reason") {
  const Law law = Law::of<NeoHookean>(isotropic, SHOAL_PLANE_STRESS);
  const double F[4] = {-1.0, 0.0, 0.0, 1.0};
  double P[4];
  shoal_stress_block block{};
  block.size = sizeof block;
  block.kinematics = SHOAL_PLANE_STRESS;
  block.n = 1;
  block.deformation_gradient = F;
  block.stress = P;
  CHECK(law.law->stress(law.self(), &block) == SHOAL_PHYSICS_FAILED);
  CHECK(failure ==
        "a material finds no thickness at which the stress out of the plane vanishes: particles are turned "
        "inside out");
}
