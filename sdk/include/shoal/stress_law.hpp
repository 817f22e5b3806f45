// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// StressLaw: a solid material by its energy and stress, written in three dimensions for one particle:
//
//     struct NeoHookean final : StressLaw {
//       Param<double> density{...}, shear{...}, lame{...};
//       double reference_density() const override { return density; }
//       double bulk_modulus() const override { return lame + 2.0 / 3.0 * shear; }
//       double shear_modulus() const override { return shear; }
//       Mat<3, Pack> stress(const Mat<3, Pack>& F, LawPoint&) const override {
//         const Mat<3, Pack> back = transpose(inverse(F));
//         return shear * (F - back) + (lame * log(determinant(F))) * back;
//       }
//       Pack energy(const Mat<3, Pack>& F, LawPoint&) const override { ... }
//     };
//
// A Pack holds as many particles as fit a SIMD register. From this come the interface of
// shoal/interfaces/stress_law.h, plane strain, plane stress (the thickness stretch at which P33 = 0) and wave speeds.
// Directions, state and other fields are members (law_point.hpp): a law reads them with `point(fibre)` and writes its
// state with `point.set(strain, value)`.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "shoal/interfaces/stress_law.h"
#include "shoal/law_point.hpp"
#include "shoal/material.hpp"
#include "shoal/pack_scatter.hpp"
#include "shoal/vec.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

class StressLaw : public Material {
 public:
  using Tensor = Mat<3, Pack>;

  virtual double reference_density() const = 0;  // kg/m3
  virtual double bulk_modulus() const = 0;       // Pa, undeformed
  virtual double shear_modulus() const = 0;  // Pa, undeformed; a typical one if it depends on the direction
  // First Piola-Kirchhoff stress in Pa and stored energy in J/m3.
  virtual Mat<3, Pack> stress(const Mat<3, Pack>& F, LawPoint& point) const = 0;
  virtual Pack energy(const Mat<3, Pack>& F, LawPoint& point) const = 0;
  // Whether the energy is U(J) and a part that depends on the shape alone, and then -U'(J), the pressure; see
  // interfaces/stress_law.h. A solver smooths the pressure of nearly incompressible materials that keep the two apart.
  virtual bool keeps_volume_apart() const { return false; }
  virtual Pack volumetric_pressure(Pack J) const { return -bulk_modulus() * (J - 1.0); }
  // Whether waves become faster as the material is deformed, so that the time step must follow.
  virtual bool stiffens() const { return false; }
  // rho0 c^2 of the fastest wave on top of F in Pa, c measured in the reference configuration. The default finds it
  // from differences of the stress, which costs about twenty stresses in space.
  virtual inline Pack wave_modulus(std::uint32_t kinematics, const Tensor& F, LawPoint& point) const;

  const void* interface(std::string_view name, std::uint32_t revision) const override {
    if (name != SHOAL_STRESS_LAW || revision != SHOAL_STRESS_LAW_REVISION) return nullptr;
    if (keeps_volume_apart()) return stiffens() ? &table<true, true>() : &table<false, true>();
    return stiffens() ? &table<true, false>() : &table<false, false>();
  }

 protected:
  StressLaw() = default;

 private:
  friend class LawField;
  // dP_iJ / dF_kL as [3 k + L](i, J).
  using Tangent = std::array<Tensor, 9>;

  static StressLaw& of(void* self) { return material_of<StressLaw>(self); }
  static int dimensions_of(std::uint32_t kinematics) { return kinematics == SHOAL_THREE_DIMENSIONAL ? 3 : 2; }

  template <bool speeds, bool apart>
  static const shoal_stress_law& table();

  inline const std::vector<shoal_access>& accesses(std::uint32_t kinematics);
  inline void initialise(std::uint32_t kinematics, std::uint64_t n, const double* position,
                         double* const* fields) const;
  inline void constants(std::uint32_t kinematics, shoal_elastic_constants& out) const;
  inline void stresses(const shoal_stress_block& block) const;
  inline void pressures(std::uint64_t n, const double* J, double* p) const;
  inline void wave_speeds(const shoal_stress_block& block, double* speed) const;

  inline Tensor stress_in(std::uint32_t kinematics, Tensor& F, LawPoint& point) const;
  inline Tensor plane_stress(Tensor& F, LawPoint& point) const;
  inline Tangent tangent(std::uint32_t kinematics, const Tensor& F, LawPoint& point) const;
  inline static Pack stiffest(const Tangent& tangent, int dimensions, int iterations);

  std::vector<LawField*> fields_;
  std::array<std::vector<shoal_access>, 2> accesses_;  // in space, in the plane
};

inline LawField::LawField(StressLaw& law) { law.fields_.push_back(this); }

template <bool speeds, bool apart>
const shoal_stress_law& StressLaw::table() {
  static const shoal_stress_law functions{
      sizeof(shoal_stress_law),
      0,
      [](void* self, uint32_t kinematics, uint32_t* n) {
        const std::vector<shoal_access>& list = of(self).accesses(kinematics);
        *n = static_cast<uint32_t>(list.size());
        return list.data();
      },
      [](void* self, uint32_t kinematics, uint64_t n, const double* position, double* const* fields) {
        return guarded([&] { of(self).initialise(kinematics, n, position, fields); });
      },
      [](void* self, uint32_t kinematics, shoal_elastic_constants* out) {
        of(self).constants(kinematics, *out);
      },
      [](void* self, const shoal_stress_block* block) { return guarded([&] { of(self).stresses(*block); }); },
      apart ? +[](void* self, uint64_t n, const double* J, double* p) { of(self).pressures(n, J, p); }
            : nullptr,
      speeds ? +[](void* self, const shoal_stress_block* block,
                   double* speed) { return guarded([&] { of(self).wave_speeds(*block, speed); }); }
             : nullptr};
  return functions;
}

inline const std::vector<shoal_access>& StressLaw::accesses(std::uint32_t kinematics) {
  const int d = dimensions_of(kinematics);
  std::vector<shoal_access>& list = accesses_[d == 2];
  if (!list.empty()) return list;
  for (LawField* field : fields_) {
    field->first_[d == 2] = list.size();
    for (const shoal_access& access : field->accesses(d)) list.push_back(access);
  }
  return list;
}

inline void StressLaw::initialise(std::uint32_t kinematics, std::uint64_t n, const double* position,
                                  double* const* fields) const {
  const int d = dimensions_of(kinematics);
  for (const LawField* field : fields_) field->initialise(d, n, position, fields);
}

// ---------------------------------------------------------------------------------------------------------------
// Blocks

namespace law_detail {

// F of the particles of a pack in three dimensions, F33 = 1 in the plane.
inline Mat<3, Pack> load_in_space(const double* F, int dimensions, IndexPack index) {
  if (dimensions == 3) return gather_mat<3>(F, index);
  const Mat<2, Pack> plane = gather_mat<2>(F, index);
  return {plane(0, 0), plane(0, 1), 0.0, plane(1, 0), plane(1, 1), 0.0, 0.0, 0.0, 1.0};
}
// Lanes behind the last particle repeat it (LawPoint::indices), so writing them changes nothing.
inline void store_from_space(const Mat<3, Pack>& P, int dimensions, const LawPoint& point, double* out) {
  if (dimensions == 3) return scatter_tuple<9>(P.e, point.indices(), out);
  const Pack plane[4] = {P(0, 0), P(0, 1), P(1, 0), P(1, 1)};
  scatter_tuple<4>(plane, point.indices(), out);
}
inline void store_numbers(Pack x, const LawPoint& point, double* out) {
  for (std::uint64_t lane = 0; lane < point.n(); ++lane)
    out[point.first() + lane] = x[static_cast<int>(lane)];
}

}  // namespace law_detail

inline void StressLaw::stresses(const shoal_stress_block& block) const {
  const int d = dimensions_of(block.kinematics);
  for (std::uint64_t first = 0; first < block.n; first += static_cast<std::uint64_t>(lanes)) {
    LawPoint point(block, d, first);
    Tensor F = law_detail::load_in_space(block.deformation_gradient, d, point.indices());
    const Tensor P = stress_in(block.kinematics, F, point);
    if (block.stress) law_detail::store_from_space(P, d, point, block.stress);
    if (block.energy) law_detail::store_numbers(energy(F, point), point, block.energy);
    if (block.out_of_plane_stress) law_detail::store_numbers(P(2, 2), point, block.out_of_plane_stress);
    if (block.out_of_plane_stretch) law_detail::store_numbers(F(2, 2), point, block.out_of_plane_stretch);
    if (block.flags & SHOAL_STRESS_UPDATES_STATE) point.keep();
  }
}

inline void StressLaw::pressures(std::uint64_t n, const double* J, double* p) const {
  double in[lanes], out[lanes];
  for (std::uint64_t first = 0; first < n; first += static_cast<std::uint64_t>(lanes)) {
    const std::uint64_t many = std::min<std::uint64_t>(lanes, n - first);
    std::fill_n(std::copy_n(J + first, many, in), lanes - static_cast<int>(many), 1.0);
    volumetric_pressure(Pack::load(in)).store(out);
    std::copy_n(out, many, p + first);
  }
}

inline StressLaw::Tensor StressLaw::stress_in(std::uint32_t kinematics, Tensor& F, LawPoint& point) const {
  return kinematics == SHOAL_PLANE_STRESS ? plane_stress(F, point) : stress(F, point);
}

// Finds F33 such that P33 = 0 by the secant rule, lane by lane: a lane that has found it stays where it is, so that
// it does not depend on its company. It begins with what linear elasticity says of the area.
inline StressLaw::Tensor StressLaw::plane_stress(Tensor& F, LawPoint& point) const {
  const double K = bulk_modulus(), G = shear_modulus(), modulus = K + 4.0 / 3.0 * G;
  const double exponent = -(K - 2.0 / 3.0 * G) / modulus;  // -nu / (1 - nu)
  const Pack area = F(0, 0) * F(1, 1) - F(0, 1) * F(1, 0);
  Pack s = area.each([&](double a) { return std::pow(a, exponent); });
  Pack s_before = s, P_before = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    F(2, 2) = s;
    const Tensor P = stress(F, point);
    const Mask done = abs(P(2, 2)) <= Pack(1e-13 * modulus);
    if (all(done)) return P;
    const Pack secant = (P(2, 2) - P_before) / (s - s_before);
    const Pack slope =
        iteration == 0 ? Pack(modulus) : select(secant > 1e-3 * modulus, secant, Pack(modulus));
    const Pack next = min(2.0 * s, max(0.5 * s, s - P(2, 2) / slope));
    // Where rounding lets it come no nearer, the step is below the last digit.
    if (all(done | (abs(next - s) <= 4e-16 * s))) return P;
    s_before = select(done, s_before, s);
    P_before = select(done, P_before, P(2, 2));
    s = select(done, s, next);
  }
  throw PhysicsFailed(
      "a material finds no thickness at which the stress out of the plane vanishes: particles are turned "
      "inside out");
}

// ---------------------------------------------------------------------------------------------------------------
// Wave speeds: rho c^2 is the largest value of a_i N_J (dP_iJ / dF_kL) a_k N_L over unit vectors a, N.

inline StressLaw::Tangent StressLaw::tangent(std::uint32_t kinematics, const Tensor& F,
                                             LawPoint& point) const {
  const int d = dimensions_of(kinematics);
  constexpr double step = 1e-5;
  Tangent tangent{};
  for (int k = 0; k < d; ++k)
    for (int L = 0; L < d; ++L) {
      Tensor more = F, less = F;
      more(k, L) += step;
      less(k, L) -= step;
      tangent[static_cast<std::size_t>(3 * k + L)] =
          (stress_in(kinematics, more, point) - stress_in(kinematics, less, point)) * (0.5 / step);
    }
  return tangent;
}

// Climbs from each axis in turn: first a, then N is turned towards what the other one makes largest. The value only
// ever rises; the shift keeps the eigenvalue of largest size on top.
inline Pack StressLaw::stiffest(const Tangent& tangent, int dimensions, int iterations) {
  using V = Vec<3, Pack>;
  Pack shift = 0.0;
  for (const Tensor& t : tangent) shift += double_dot(t, t);
  shift = 0.1 * sqrt(shift);
  const auto value_along = [&](const V& a, const V& N, V& towards_a, V& towards_N) {
    towards_a = towards_N = V{};
    for (int k = 0; k < dimensions; ++k)
      for (int L = 0; L < dimensions; ++L) {
        const Tensor& t = tangent[static_cast<std::size_t>(3 * k + L)];
        towards_a += (a[k] * N[L]) * (t * N);
        towards_N += (a[k] * N[L]) * (transpose(t) * a);
      }
    return dot(a, towards_a);
  };
  Pack largest = 0.0;
  for (int axis = 0; axis < dimensions; ++axis) {
    V N{0.15, 0.1, dimensions == 3 ? 0.05 : 0.0}, on_a{}, on_N{};
    N[axis] = 1.0;
    N = normalized(N);
    V a = N;
    for (int k = 0; k < iterations; ++k) {
      value_along(a, N, on_a, on_N);
      a = normalized(on_a + shift * a);
      value_along(a, N, on_a, on_N);
      N = normalized(on_N + shift * N);
    }
    largest = max(largest, value_along(a, N, on_a, on_N));
  }
  return largest;
}

inline Pack StressLaw::wave_modulus(std::uint32_t kinematics, const Tensor& F, LawPoint& point) const {
  return stiffest(tangent(kinematics, F, point), dimensions_of(kinematics), 12);
}

inline void StressLaw::wave_speeds(const shoal_stress_block& block, double* speed) const {
  const int d = dimensions_of(block.kinematics);
  for (std::uint64_t first = 0; first < block.n; first += static_cast<std::uint64_t>(lanes)) {
    LawPoint point(block, d, first);
    const Tensor F = law_detail::load_in_space(block.deformation_gradient, d, point.indices());
    law_detail::store_numbers(sqrt(wave_modulus(block.kinematics, F, point) / reference_density()), point,
                              speed);
  }
}

inline void StressLaw::constants(std::uint32_t kinematics, shoal_elastic_constants& out) const {
  const int d = dimensions_of(kinematics);
  std::array<std::array<double, 9>, 32> values{};
  std::array<double*, 32> fields{};
  for (std::size_t k = 0; k < fields.size(); ++k) fields[k] = values[k].data();
  std::size_t direction = 0;
  for (const LawField* field : fields_) field->set_typical(d, direction, fields.data());

  shoal_stress_block block{};
  block.size = sizeof block;
  block.kinematics = kinematics;
  block.n = 1;
  block.fields = fields.data();
  LawPoint point(block, d, 0);
  const Pack stiffness = stiffest(tangent(kinematics, identity<3, Pack>(), point), d, 60);
  out.density = reference_density();
  out.bulk_modulus = bulk_modulus();
  out.shear_modulus = shear_modulus();
  out.longitudinal_speed = std::sqrt(stiffness[0] / reference_density());
  out.shear_speed = std::sqrt(shear_modulus() / reference_density());
}

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
