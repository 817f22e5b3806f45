// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Every law of the solid plugin with values that make each of its terms matter.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "law.hpp"
#include "plugins/solid/materials/guccione.hpp"
#include "plugins/solid/materials/holzapfel_ogden.hpp"
#include "plugins/solid/materials/johnson_cook.hpp"
#include "plugins/solid/materials/mooney_rivlin.hpp"
#include "plugins/solid/materials/neo_hookean.hpp"
#include "plugins/solid/materials/orthotropic.hpp"
#include "plugins/solid/materials/plastic.hpp"
#include "plugins/solid/materials/st_venant_kirchhoff.hpp"

namespace material_test {

struct Named {
  std::string name;
  std::function<Law(std::uint32_t kinematics, std::size_t n)> make;
  bool isotropic, split, elastic;
};

template <class M>
Named named(const char* name, Values values, bool isotropic, bool split, bool elastic = true) {
  return {name,
          [values](std::uint32_t kinematics, std::size_t n) { return Law::of<M>(values, kinematics, n); },
          isotropic, split, elastic};
}

// Literals, not sqrt(0.75): clang 14 sets such an inline variable at the start of the program after those below that are
// made from it, whose directions were then (0, s30, 0).
constexpr double c30 = 0.8660254037844386, s30 = 0.5;
inline const Values holzapfel_ogden{{"density", 1060.0},
                                    {"bulk_modulus", 30.0},
                                    {"a", 0.59},
                                    {"b", 2.0},
                                    {"a_f", 1.8},
                                    {"b_f", 1.6},
                                    {"a_s", 0.7},
                                    {"b_s", 1.1},
                                    {"a_fs", 0.4},
                                    {"b_fs", 1.5},
                                    {"fibre", {c30, s30, 0.0}},
                                    {"sheet", {-s30, c30, 0.0}}};
inline Values with(Values values, const char* key, Given given) {
  values.insert_or_assign(key, std::move(given));
  return values;
}

inline std::vector<Named> all_laws() {
  using namespace shoal::solid;
  const Values isotropic{{"density", 1200.0}, {"youngs_modulus", 7.0}, {"poisson_ratio", 0.35}};
  const Values metal = with(with(isotropic, "yield_stress", 1e3), "hardening", 1.0);
  return {
      named<StVenantKirchhoff>("St. Venant-Kirchhoff", isotropic, true, false),
      named<NeoHookean>("neo-Hookean, split", isotropic, true, true),
      named<NeoHookean>("neo-Hookean, coupled", with(isotropic, "form", "coupled"), true, false),
      named<MooneyRivlin>("Mooney-Rivlin",
                          {{"density", 1100.0}, {"c1", 0.8}, {"c2", 0.3}, {"bulk_modulus", 9.0}}, true, true),
      named<Orthotropic>("orthotropic",
                         {{"density", 700.0},
                          {"youngs_moduli", {12.0, 3.0, 5.0}},
                          {"poisson_ratios", {0.4, 0.2, 0.3}},
                          {"shear_moduli", {2.0, 1.0, 1.5}},
                          {"fibre", {c30, s30, 0.0}},
                          {"sheet", {-s30, c30, 0.0}}},
                         false, false),
      named<HolzapfelOgden>("Holzapfel-Ogden", holzapfel_ogden, false, false),
      named<HolzapfelOgden>("Holzapfel-Ogden, fibres push", with(holzapfel_ogden, "fibres_push", 1.0), false,
                            false),
      named<HolzapfelOgden>("Holzapfel-Ogden, ground substance",
                            {{"density", 1060.0}, {"bulk_modulus", 30.0}, {"a", 1.5}, {"b", 1.2}}, true,
                            false),
      named<Guccione>("Guccione",
                      {{"density", 1060.0},
                       {"c", 2.0},
                       {"b_f", 3.0},
                       {"b_t", 0.8},
                       {"b_fs", 1.4},
                       {"bulk_modulus", 12.0},
                       {"fibre", {c30, s30, 0.0}}},
                      false, true),
      named<Plastic>("plastic, below yield", metal, true, true),
      named<Plastic>(
          "plastic, yielding",
          with(with(with(metal, "yield_stress", 0.3), "saturation_stress", 0.8), "saturation_rate", 6.0),
          true, true, false),
      named<JohnsonCook>("Johnson-Cook",
                         with(with(with(with(with(with(isotropic, "a", 0.2), "b", 0.5), "n", 0.4), "c", 0.05),
                                   "melting_temperature_rise", 900.0),
                              "heat_capacity", 400.0),
                         true, true, false),
  };
}

inline const std::vector<std::uint32_t> all_kinematics{SHOAL_THREE_DIMENSIONAL, SHOAL_PLANE_STRAIN,
                                                       SHOAL_PLANE_STRESS};

}  // namespace material_test
