// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A third party's materials, as one would write them: a law of one's own, and one that wraps a law of any plugin.
#include <vector>

#include "shoal/shoal.hpp"
#include "shoal/stress_law.hpp"

namespace {

using namespace shoal;

// Gent 1996: rubber whose chains become taut, W = -mu Jm/2 ln(1 - (J^(-2/3) I1 - 3)/Jm) + K/4 (J^2 - 1 - 2 ln J).
struct Gent final : StressLaw {
  Param<double> density{"density", "kg/m3", "Density.", positive};
  Param<double> mu{"shear_modulus", "Pa", "Shear modulus.", positive};
  Param<double> K{"bulk_modulus", "Pa", "Bulk modulus.", positive};
  Param<double> taut{"taut", "1", "I1 - 3 at which the chains are taut.", positive};

  double reference_density() const override { return density; }
  double bulk_modulus() const override { return K; }
  double shear_modulus() const override { return mu; }

  Tensor stress(const Tensor& F, LawPoint&) const override {
    const Pack J = determinant(F), shape = pow(J, -2.0 / 3.0), I1 = double_dot(F, F);
    const Pack stiffness = mu.value() * shape / (1.0 - (shape * I1 - 3.0) / taut.value());
    const Tensor back = transpose(inverse(F));
    return stiffness * F + (0.5 * K * (J * J - 1.0) - stiffness * I1 / 3.0) * back;
  }
  Pack energy(const Tensor& F, LawPoint&) const override {
    const Pack J = determinant(F), I1 = pow(J, -2.0 / 3.0) * double_dot(F, F);
    return -0.5 * mu * taut * log(1.0 - (I1 - 3.0) / taut.value()) + 0.25 * K * (J * J - 1.0 - 2.0 * log(J));
  }
  bool stiffens() const override { return true; }
};

// Any law, pulled together along x: P = P_passive + T F e_x (x) e_x.
struct Active final : Material {
  Param<ObjectHandle> passive{"passive", nullptr, "Stress law at rest.", materials_only};
  Param<double> tension{"tension", "Pa", "Active tension along x.", non_negative};

  void check() override {
    passive_ = OwnedMaterial(passive.value(), dimensions());
    law_ = passive_.interface<shoal_stress_law>(SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION);
    if (law_ == nullptr) throw CaseError(passive.place() + ": this material has no stress law");
  }
  const void* interface(std::string_view name, std::uint32_t revision) const override {
    return name == SHOAL_STRESS_LAW && revision == SHOAL_STRESS_LAW_REVISION ? &table_ : nullptr;
  }

 private:
  static Active& of(void* self) { return material_of<Active>(self); }
  void* inner() const { return passive_.self(); }

  shoal_status stress(const shoal_stress_block& block) const {
    const shoal_status status = law_->stress(inner(), &block);
    const std::uint64_t d = block.kinematics == SHOAL_THREE_DIMENSIONAL ? 3 : 2;
    for (std::uint64_t i = 0; i < block.n && block.stress != nullptr; ++i)
      for (std::uint64_t row = 0; row < d; ++row)
        block.stress[(i * d + row) * d] += tension * block.deformation_gradient[(i * d + row) * d];
    return status;
  }

  OwnedMaterial passive_;
  const shoal_stress_law* law_ = nullptr;

  static const shoal_stress_law table_;
};

// Outside of the class, in whose static initialisers it is still incomplete.
const shoal_stress_law Active::table_{
    sizeof(shoal_stress_law),
    0,
    [](void* self, std::uint32_t kinematics, std::uint32_t* n) {
      return of(self).law_->fields(of(self).inner(), kinematics, n);
    },
    [](void* self, std::uint32_t kinematics, std::uint64_t n, const double* position, double* const* fields) {
      return of(self).law_->initialise(of(self).inner(), kinematics, n, position, fields);
    },
    [](void* self, std::uint32_t kinematics, shoal_elastic_constants* constants) {
      of(self).law_->constants(of(self).inner(), kinematics, constants);
    },
    [](void* self, const shoal_stress_block* block) { return of(self).stress(*block); },
    [](void* self, std::uint64_t n, const double* J, double* p) {
      of(self).law_->volumetric_pressure(of(self).inner(), n, J, p);
    },
    nullptr};

}  // namespace

SHOAL_PLUGIN(rubber, "1.0.0") {
  summary("Materials of a third party.");
  add<Gent>("rubber.gent", "Rubber whose chains become taut.", "Gent 1996");
  add<Active>("rubber.active", "Any law, pulled together along x.");
}
